// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// Types of messages, as bags name them.
[[nodiscard]] bool is_livox(std::string_view type);
[[nodiscard]] bool is_cloud(std::string_view type);  ///< PointCloud2 or Livox's
[[nodiscard]] bool is_odometry(std::string_view type);
[[nodiscard]] bool is_imu(std::string_view type);
[[nodiscard]] bool is_transforms(std::string_view type);

/// The topics to read: those asked for, else the first of each type, without truth; empty where there is none. A topic
/// with hardly any clouds, as of a map, is no first one beside a topic with many. Throws InputError at the mark where
/// no topic holds clouds, or one asked for is not there or of another type.
[[nodiscard]] BagTopics choose_topics(MessageSource& source, const BagTopics& asked, const Mark& mark);

/// The topics of clouds besides `points`.
[[nodiscard]] std::vector<std::string> other_clouds(const MessageSource& source, std::string_view points);
/// " (/front, /rear)"; empty where there are none.
[[nodiscard]] std::string in_brackets(const std::vector<std::string>& names);

/// Whether a topic that could be read holds odometry, which is no truth.
[[nodiscard]] bool holds_odometry(const MessageSource& source);

/// The topic of transforms that move, /tf or that of a robot's namespace. Empty where there is none.
[[nodiscard]] std::string moving_transforms(const MessageSource& source);

/// The topic of transforms that stand still: /tf_static, else that of a robot's namespace, where there is one alone or
/// one that the points are in, too. Empty where there is none.
[[nodiscard]] std::string static_transforms(const MessageSource& source, std::string_view points);

}  // namespace plumbline::slam
