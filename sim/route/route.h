// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/building/building.h"

namespace plumbline::sim {

/// 2D free space of one storey of the as-built building at robot height, eroded by the robot's radius.
class FreeSpace {
 public:
  FreeSpace(const bim::Building& as_built, int storey, double radius_m = 0.40, double cell_m = 0.05);

  [[nodiscard]] bool free(const Eigen::Vector2d& p) const;
  /// Distance to the nearest obstacle, m (0 in a wall).
  [[nodiscard]] double clearance(const Eigen::Vector2d& p) const;
  /// Shortest path that keeps clear of walls, as few waypoints as that allows; empty when b cannot be reached from a.
  [[nodiscard]] std::vector<Eigen::Vector2d> path(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// The free point of a room with the most clearance (ties: lowest cell), or none.
  [[nodiscard]] std::vector<Eigen::Vector2d> room_target(const Polygon2& room) const;

 private:
  Eigen::Vector2d origin_;
  int nx_ = 0, ny_ = 0;
  double cell_ = 0.05, radius_ = 0.4;
  std::vector<float> clearance_;
};

}  // namespace plumbline::sim
