// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::sim {

/// Velocity command in the robot's heading frame.
struct Command {
  double vx = 0.0;                 ///< m/s
  double vy = 0.0;                 ///< m/s
  double yaw_rate = 0.0;           ///< rad/s
  double gait_period_scale = 1.0;  ///< of the nominal period; varied so that the gait does not lock to the sensor
  bool slow_gait = false;          ///< longer with all four feet on the ground, for stairs
};

}  // namespace plumbline::sim
