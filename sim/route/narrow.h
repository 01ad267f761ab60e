// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/route/route.h"
#include "sim/route/waypoint.h"

namespace plumbline::sim {

struct NarrowConfig {
  double narrow_m = 0.6;  ///< less clearance than this is narrow
  double before_m = 0.2;  ///< a narrow stretch begins this much before and ends this much behind it;
  double apart_m = 0.5;   ///< two that are nearer than this to each other are one
  double sample_m = 0.025;
};

/// The path on a floor at floor_z_W as waypoints with the clearance of the segment to them, where that is narrow. A
/// segment with a narrow stretch is divided at its ends.
[[nodiscard]] std::vector<Waypoint> with_clearance(const ClearanceMap& space, const std::vector<Eigen::Vector2d>& path,
                                                   double floor_z_W, const NarrowConfig& config = {});

}  // namespace plumbline::sim
