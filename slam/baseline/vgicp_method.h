// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/method.h"

namespace plumbline::slam {

/// LiDAR odometry alone: every deskewed scan registered to a sliding local map, see VgicpOdometry. M is the robot's
/// pose at the first scan. No loop is ever closed.
[[nodiscard]] std::unique_ptr<Method> make_vgicp_method(const MethodInput& input);

}  // namespace plumbline::slam
