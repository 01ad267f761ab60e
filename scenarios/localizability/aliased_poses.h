// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scenarios/localizability/place_index.h"

namespace plumbline::scenarios {

/// The scan at a pose in the building as built, and how well the plan explains it there.
struct ReferenceScan {
  SensorPose place;
  std::vector<double> range_m;  ///< of RangeImager's default beams
  double own = 0.0;             ///< cost of the plan's range image at the pose itself
};

/// A pose at which the plan explains a scan nearly as well as at its own.
struct FoundAlias {
  SensorPose place;
  double llr = 0.0;  ///< of the scan: cost there less the scan's own; at most drop_llr
};

/// Which storeys and headings an alias may have.
struct AliasSearch {
  int storey = -1;  ///< of the index; -1: all
  bool yaw_known = false;
};

/// Looks for poses that a scan cannot tell from its own, docs/methods/localizability.md: candidates by signature,
/// refined on planes, judged by the log-likelihood ratio. Everything must outlive it. May be used by several threads.
class AliasFinder {
 public:
  AliasFinder(const PlaceIndex& index, const bim::RayScene& as_planned, const bim::RayScene& as_built);

  [[nodiscard]] ReferenceScan scan_at(const SensorPose& place) const;
  /// Log-likelihood ratio of the pose of a scan over another pose.
  [[nodiscard]] double llr(const ReferenceScan& scan, const SensorPose& other) const;
  /// Nearly surely llr > drop_llr, by a fortieth of the beams.
  [[nodiscard]] bool clearly_different(const ReferenceScan& scan, const SensorPose& other) const;
  /// Aliases of a scan, apart from itself and from `known` ones, in the order they were found.
  [[nodiscard]] std::vector<FoundAlias> find(const ReferenceScan& scan, const AliasSearch& search,
                                             std::span<const SensorPose> known = {}) const;

 private:
  [[nodiscard]] bool refine(const RangeImage& seen, SensorPose& place) const;

  const PlaceIndex& index_;
  const bim::RayScene& as_planned_;
  const bim::RayScene& as_built_;
  RangeImager imager_;
  RangeImager coarse_;
};

}  // namespace plumbline::scenarios
