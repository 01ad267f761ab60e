// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace plumbline::sim {

/// A corner of the robot's path, on the floor.
struct Waypoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< m, z that of the floor there
  bool stairs = false;                            ///< the segment from the waypoint before goes over steps
  double clearance_m = std::numeric_limits<double>::infinity();  ///< least on that segment, where it is narrow
};

/// A path on one level.
[[nodiscard]] std::vector<Waypoint> on_floor(const std::vector<Eigen::Vector2d>& points_W, double floor_z_W);

/// Length of a path, m: of all of it, and of the part over stairs.
[[nodiscard]] double length(const std::vector<Waypoint>& way);
[[nodiscard]] double length_on_stairs(const std::vector<Waypoint>& way);

}  // namespace plumbline::sim
