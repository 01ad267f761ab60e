// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>

#include "scenarios/localizability/range_image.h"

namespace plumbline::scenarios {

/// The element that distinguishes a pose from another: most of the log-likelihood ratio comes from beams to it.
struct DecidingFeature {
  bool missing = false;  ///< it would be visible from the other pose, and is not; else it is visible, and would not be
  int element = -1;      ///< of the planned mesh where missing, else of the one as built
  double share = 0.0;    ///< of the positive evidence
};

/// What stands in a building as planned and as built.
struct ComparedScenes {
  const bim::RayScene* as_planned = nullptr;
  const bim::RayScene* as_built = nullptr;
  std::span<const char> loose;  ///< by element as built: may have moved and does not stand as planned; empty: none
};

/// The scan at a place as it is, and as the plan predicts it there.
struct SeenPlace {
  RangeImage seen, own;
};
[[nodiscard]] SeenPlace see(const RangeImager& imager, const ComparedScenes& scenes, const SensorPose& place);

/// Log-likelihood ratio of a pose over another one, by what its scans meet.
struct ElementEvidence {
  double llr = 0.0;
  double by_furniture = 0.0;  ///< what furniture where the other pose has a wall says for that one, not capped
  std::map<std::pair<bool, int>, double> by_element;  ///< keys as DecidingFeature has them

  /// Adds one scan. Furniture that stands where the other pose has a wall is one coincidence, however often it is seen:
  /// by it alone llr falls to -marginal_llr and no further.
  void add(const RangeImager& imager, const ComparedScenes& scenes, const SeenPlace& place, const SensorPose& other);
  /// Absent where nothing speaks for the pose.
  [[nodiscard]] std::optional<DecidingFeature> deciding() const;
};

}  // namespace plumbline::scenarios
