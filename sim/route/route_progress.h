// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace plumbline::sim {

/// When a robot that is commanded to walk counts as stalled.
struct ProgressConfig {
  double stuck_s = 6.0;             ///< without progress on the floor,
  double stuck_on_stairs_s = 10.0;  ///< or on a stair, where it slips back more
  double distance_m = 0.15;         ///< nearer by this to the end of a segment than ever on it is progress,
  double angle = 0.15;              ///< or by this (rad) to the commanded heading
};

/// Detects a stall. Only a new best distance or heading error counts as progress; stepping on the spot does not.
class Progress {
 public:
  explicit Progress(const ProgressConfig& config) : config_(config) {}

  /// True when the robot is stalled at time t_s, with left_m to the end of `segment` and `error` (rad) off the
  /// commanded heading.
  [[nodiscard]] bool stalled(std::size_t segment, bool stairs, double left_m, double error, double t_s);
  /// Since the last progress.
  [[nodiscard]] double idle_s(double t_s) const { return t_s - since_s_; }
  /// Counts from this time on.
  void begin_again(double t_s) { since_s_ = t_s; }

 private:
  ProgressConfig config_;
  bool started_ = false;
  std::size_t segment_ = 0;
  double least_left_m_ = 0.0;
  double least_error_ = 0.0;
  double since_s_ = 0.0;
};

}  // namespace plumbline::sim
