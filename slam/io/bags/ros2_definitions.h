// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "slam/io/bags/message_sink.h"

namespace plumbline::slam {

/// Name of a type in ROS 2: "sensor_msgs/msg/PointCloud2".
[[nodiscard]] std::string ros2_type(MessageType type);
/// Its definition and those of the types in it, as bags carry them (ros2msg).
[[nodiscard]] std::string ros2_definition(MessageType type);
/// offered_qos_profiles in Humble's words: reliable, the last ten; latched topics are kept for who comes later.
[[nodiscard]] std::string ros2_qos(bool latched);

}  // namespace plumbline::slam
