// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/building/building.h"
#include "sim/robot/robot.h"

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

/// Pure pursuit along waypoints [facts: legged section 5] with command jitter, so that the gait is not phase-locked.
class Follower {
 public:
  Follower(std::vector<Eigen::Vector2d> waypoints, double speed_mps, std::uint64_t seed);
  /// Command for the robot at X_WR; tick counts physics steps. Throws ScenarioFailure when it has been stuck.
  [[nodiscard]] Command update(const Pose& X_WR, std::int64_t tick);
  [[nodiscard]] bool done() const { return next_ >= waypoints_.size(); }

 private:
  std::vector<Eigen::Vector2d> waypoints_;
  double speed_;
  std::uint64_t seed_;
  std::size_t next_ = 1;
  bool turning_ = false;
  Eigen::Vector2d progress_point_ = Eigen::Vector2d::Zero();
  double progress_yaw_ = 0.0;
  std::int64_t progress_tick_ = 0;
};

}  // namespace plumbline::sim
