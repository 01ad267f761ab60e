// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::slam {

/// rad/s by which the yaw told at the start, carried along by odometry, grows stale [facts: legged 10].
inline constexpr double told_yaw_drift = 0.001;

}  // namespace plumbline::slam
