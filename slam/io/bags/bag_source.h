// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/bags/bag.h"
#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// Messages of a bag of any kind, told by its first bytes. Throws InputError.
[[nodiscard]] std::unique_ptr<MessageSource> open_source(const std::string& path);

}  // namespace plumbline::slam
