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
  double turn_rad = 0.0;     ///< mean turn of its observations from the plan, positive about z
};

/// Variances of what walls leave, as shares of those expected.
struct WallVariances {
  double offset = 1.0;     ///< of offsets
  double direction = 1.0;  ///< of directions
};

/// The walls of a window. Those out of sight now still hold the newest pose by odometry. bias: of ranges, m.
[[nodiscard]] std::vector<SeenWall> seen_walls(const std::deque<TrackedPose>& window, const StoreyIndex& storey,
                                               double bias, const TrackerConfig& config);

/// Information about (x, y, yaw, range bias) by walls that each count once, since a wall that stands off the plan
/// shifts and turns all its observations alike.
[[nodiscard]] Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, const WallVariances& variances,
                                               const TrackerConfig& config);

/// What is known of the range bias beside the walls of a window.
struct BiasPrior {
  double mean_m = 0.0;
  double variance = 1.0;  ///< m^2
  double used_m = 0.0;    ///< in the walls' residuals
};

/// How much larger or smaller the walls' residuals are than expected: variances of unit weight, of offsets and of
/// directions apart, by the residuals that are left by the pose that fits a window's walls best and their number less
/// what was fitted. Walls that are straight but stand off the plan tell the yaw well, and crooked ones the position.
class WallVarianceFactor {
 public:
  /// Takes in the walls of a window, of which each pose brings its part.
  void add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config);

  [[nodiscard]] const WallVariances& value() const { return value_; }

 private:
  /// Squares of whitened residuals, and how many of them are free.
  struct Sum {
    double squares = 0.0, freedom = 0.0;
    void add(const Sum& window, const TrackerConfig& config);
    [[nodiscard]] double mean(const TrackerConfig& config) const;
  };

  WallVariances value_;
  Sum offsets_, directions_;
};

}  // namespace plumbline::slam
