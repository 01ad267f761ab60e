// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// Opens a ROS 1 bag after check_bag(), one that rosbag cannot read by open_unindexed_bag(). Throws InputError.
[[nodiscard]] std::unique_ptr<MessageSource> open_ros1_bag(const std::string& path);

}  // namespace plumbline::slam
