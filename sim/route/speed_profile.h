// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "sim/route/waypoint.h"

namespace plumbline::sim {

/// Speed limits of a path at bends, in narrow passages and over stairs.
struct SpeedConfig {
  double speed_mps = 0.6;        ///< without obstacles nearby
  double stairs_mps = 0.25;      ///< highest on stairs
  double braking = 0.7;          ///< m/s^2, before whatever asks for less
  double corner_m = 0.25;        ///< a bend begins this far before its waypoint,
  double corner_rate = 0.8;      ///< is walked with this yaw rate, rad/s,
  double corner_min_mps = 0.25;  ///< and never slower than this
  double half_width_m = 0.25;    ///< of the robot; what is clear beyond it
  double narrow_s = 0.25;        ///< must last for this time
  double narrow_min_mps = 0.3;   ///< but no narrow passage is walked slower than this
};

/// Speed limits along a path.
class SpeedProfile {
 public:
  SpeedProfile(const SpeedConfig& config, const std::vector<Waypoint>& way);

  /// Highest speed on the segment to waypoint `next` with so much of it left, m/s.
  [[nodiscard]] double limit(std::size_t next, double left_m) const;

 private:
  double braking_;
  std::vector<double> segment_limits_;   ///< on the segment to each waypoint
  std::vector<double> waypoint_limits_;  ///< at each waypoint
};

}  // namespace plumbline::sim
