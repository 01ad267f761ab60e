// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::slam {

struct StoreyIndex;
struct TrackedPose;
struct TrackerConfig;

/// What is known of the LiDAR's range bias, measured less true range, which stays as it is: a stretch that leaves it
/// open, as a corridor whose end alone is seen, must not change it. Each pose tells the more of it the more of its
/// walls face each other.
class RangeBias {
 public:
  explicit RangeBias(double sigma_m) : variance_(sigma_m * sigma_m) {}

  /// Takes in the walls of a pose that is optimised no further. share: of its information that is new, as the walls
  /// that it shares with others are off the plan alike.
  void add(const TrackedPose& pose, const StoreyIndex& storey, double share, const TrackerConfig& config);

  [[nodiscard]] double mean() const { return mean_; }  ///< m
  [[nodiscard]] double variance() const { return variance_; }

 private:
  double mean_ = 0.0;
  double variance_;
};

}  // namespace plumbline::slam
