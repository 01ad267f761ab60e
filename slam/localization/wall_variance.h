// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

namespace plumbline::slam {

struct StoreyIndex;
struct TrackedPose;
struct TrackerConfig;

/// A wall of the plan by all its observations in a window of poses.
struct SeenWall {
  Eigen::Vector4d J;         ///< of its residual, towards x, y, yaw of the newest pose in I and the range bias
  double residual_m = 0.0;   ///< mean, positive where the wall stands nearer than planned
  double information = 0.0;  ///< 1/m^2, of this mean by the observations alone
  double length = 0.0;       ///< m
  double weight = 1.0;       ///< 0 to 1, the largest of its observations'
};

/// The walls of a window. Those out of sight now still hold the newest pose by odometry. bias: of ranges, m.
[[nodiscard]] std::vector<SeenWall> seen_walls(const std::deque<TrackedPose>& window, const StoreyIndex& storey,
                                               double bias, const TrackerConfig& config);

/// Information about (x, y, yaw, range bias) by walls that each count once, since a wall that stands off the plan
/// shifts all its observations alike. factor: of the variance expected of their residuals.
[[nodiscard]] Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, double factor,
                                               const TrackerConfig& config);

/// What is known of the range bias beside the walls of a window.
struct BiasPrior {
  double mean_m = 0.0;
  double variance = 1.0;  ///< m^2
  double used_m = 0.0;    ///< in the walls' residuals
};

/// How much larger or smaller the walls' residuals are than expected: variance of unit weight, by the residuals that
/// are left by the pose that fits a window's walls best and their number less what was fitted.
class WallVarianceFactor {
 public:
  /// Takes in the walls of a window, of which each pose brings its part.
  void add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config);

  [[nodiscard]] double value() const { return value_; }

 private:
  double value_ = 1.0;
  double squares_ = 0.0, freedom_ = 0.0;
};

}  // namespace plumbline::slam
