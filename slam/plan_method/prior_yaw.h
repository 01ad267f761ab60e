// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::slam {

/// rad/s by which the uncertainty of the prior yaw, propagated by odometry, grows, docs/methods/robot.md.
inline constexpr double prior_yaw_drift = 0.001;

}  // namespace plumbline::slam
