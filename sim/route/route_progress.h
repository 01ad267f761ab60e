// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace plumbline::sim {

/// When a robot that is asked to walk counts as stalled.
struct ProgressConfig {
  double stuck_s = 6.0;             ///< without progress on the floor,
  double stuck_on_stairs_s = 10.0;  ///< or on a stair, where it slips back more
  double distance_m = 0.15;         ///< nearer by this to the end of a leg than ever on it is progress,
  double angle = 0.15;              ///< or by this (rad) to the heading asked for
};

/// Watches for steps towards the goal. Coming and going on the spot is no progress: only what beats the best so far is.
class Progress {
 public:
  explicit Progress(const ProgressConfig& config) : config_(config) {}

  /// True when the robot is stalled at time t_s, with left_m to the end of leg `leg` and `error` (rad) off the heading
  /// asked for.
  [[nodiscard]] bool stalled(std::size_t leg, bool stairs, double left_m, double error, double t_s);

 private:
  ProgressConfig config_;
  bool started_ = false;
  std::size_t leg_ = 0;
  double least_left_m_ = 0.0;
  double least_error_ = 0.0;
  double since_s_ = 0.0;
};

}  // namespace plumbline::sim
