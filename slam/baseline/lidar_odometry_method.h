// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"
#include "slam/odometry/lidar_odometry.h"

namespace plumbline::slam {

/// Odometry and mapping alone: each scan's pose as the front end gives it, never corrected.
[[nodiscard]] std::unique_ptr<Method> make_lidar_odometry_method(const MethodInput& input,
                                                                 const LidarOdometryConfig& config);

}  // namespace plumbline::slam
