// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
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

/// How far walls stand off the plan.
struct WallTolerance {
  double offset_m = 0.0;   ///< standard deviation of their offsets
  double noise = 1.0;      ///< variance of observations and odometry, as a share of that expected
  double direction = 1.0;  ///< variance of their directions, as a share of that expected
};

/// The walls of a window. Those out of sight now still hold the newest pose by odometry. bias: of ranges, m.
[[nodiscard]] std::vector<SeenWall> seen_walls(const std::deque<TrackedPose>& window, const StoreyIndex& storey,
                                               double bias, const TrackerConfig& config);

/// Information about (x, y, yaw, range bias) by walls that each count once, since a wall that stands off the plan
/// shifts and turns all its observations alike.
[[nodiscard]] Eigen::Matrix4d wall_information(const std::vector<SeenWall>& walls, const WallTolerance& tolerance,
                                               const TrackerConfig& config);

/// What is known of the range bias beside the walls of a window.
struct BiasPrior {
  double mean_m = 0.0;
  double variance = 1.0;  ///< m^2
  double used_m = 0.0;    ///< in the walls' residuals
};

/// What the walls seen so far say of how far walls stand off the plan, by what is left of their residuals where the
/// pose fits a window's walls best. Directions are apart: walls that are straight but stand off the plan tell the yaw
/// well, and crooked ones the position.
///
/// Offsets: the restricted likelihood [patterson1971] of each of some tolerances and shares of the noise. A room of
/// four walls tells little of its own, so that no single one is certain. Directions: the variance of unit weight.
class WallTolerances {
 public:
  /// The tolerances that are compared, from the least to largest_m in equal ratios, each with each share of the noise,
  /// a quarter of the one before.
  static constexpr int offsets = 10, noises = 3, count = offsets * noises;

  static constexpr double largest_m = 0.077;  ///< assumed

  explicit WallTolerances(const TrackerConfig& config);

  /// Takes in the walls of a window, of which each pose brings its part.
  void add(const std::vector<SeenWall>& walls, const BiasPrior& bias, const TrackerConfig& config);

  /// Tolerance i of count.
  [[nodiscard]] WallTolerance tolerance(int i) const;
  /// How likely they are; their sum is 1.
  [[nodiscard]] std::array<double, count> probabilities() const;
  /// Root of the mean square of the offsets' tolerance, m, and the directions' share.
  [[nodiscard]] WallTolerance mean() const;

 private:
  double least_m_;
  std::array<double, count> log_prior_{};
  std::array<double, count> log_likelihood_{};
  /// Squares of whitened turns, and how many of them are free.
  double turn_squares_ = 0.0, turn_freedom_ = 0.0;
  double direction_ = 1.0;
};

}  // namespace plumbline::slam
