// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::sim {

/// Velocity asked of the robot in its heading frame.
struct Command {
  double vx = 0.0;                 ///< m/s
  double vy = 0.0;                 ///< m/s
  double yaw_rate = 0.0;           ///< rad/s
  double gait_period_scale = 1.0;  ///< of the nominal period; varied so that the gait does not lock to the sensor
  bool careful = false;            ///< longer on all four feet, as stairs ask for
};

}  // namespace plumbline::sim
