// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "scenarios/localizability/element_evidence.h"
#include "scenarios/localizability/place_index.h"
#include "slam/io/records.h"

namespace plumbline::scenarios {

struct LocalizabilityInput {
  const bim::RayScene* as_planned = nullptr;
  const bim::RayScene* as_built = nullptr;
  std::span<const char> loose;       ///< by element as built: may have moved and does not stand as planned; empty: none
  std::span<const Pose> isometries;  ///< of the plan: VisibleBuilding::isometries
  std::vector<SearchArea> storeys;   ///< those a robot with this prior may be on
  bool yaw_known = false;
  int threads = 1;
};

struct TruthSample {
  double t_s = 0.0;
  Pose X_WR;
  double sensor_z_W = 0.66;  ///< height of the levelled sensor
};

/// A start pose that explains the scans so far as the true one does: X_alias = transform * X_WR.
struct AliasedPose {
  Pose transform;
  double llr = 0.0;
};

struct LocalizabilityStep {
  double t_s = 0.0;
  double distance_m = 0.0;
  std::vector<AliasedPose> alive;  ///< all with llr <= drop_llr, ordered by where they were found
};

/// What any estimator could have known of the pose.
struct RunIdentifiability {
  std::vector<LocalizabilityStep> steps;
  std::optional<DecidingFeature> decided_by;  ///< of the last alias; absent when the first scan sufficed or nothing did
  std::size_t places = 0;                     ///< of the plan where aliases were looked for
  bool identifiable = false;                  ///< no alias is alive at the end, of those looked for at any place
  std::optional<double> identifiable_at_s;    ///< first time from which on none is
  std::optional<double> identifiable_at_m;

  /// First time from which on every alias that is left is at least marginal (llr >= marginal_llr), absent when never.
  [[nodiscard]] std::optional<double> marginal_from_s() const;
  /// Poses aliased with X_WR at time t, the true one left out.
  [[nodiscard]] std::vector<Pose> ambiguity_set(double t_s, const Pose& X_WR) const;
};

/// Follows every start pose aliased with the true one along the run, docs/methods/localizability.md.
[[nodiscard]] RunIdentifiability compute_localizability(const LocalizabilityInput& input,
                                                        const std::vector<TruthSample>& truth);

}  // namespace plumbline::scenarios
