// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// The source with one topic more, of nav_msgs/Odometry and named "/tf: odom -> base_link", where it has no other and
/// the transforms that move hold one such joint alone, also to base_footprint or in a robot's namespace: a child with
/// one parent, which moves against it. Where base_link moves against base_footprint, too, the two are one: "/tf: odom
/// -> base_footprint -> base_link". Otherwise the source itself. Reads the transforms once through.
[[nodiscard]] std::unique_ptr<MessageSource> with_odometry_of_transforms(std::unique_ptr<MessageSource> source);

/// Whether a topic is one that with_odometry_of_transforms() adds.
[[nodiscard]] bool is_of_transforms(std::string_view topic);

}  // namespace plumbline::slam
