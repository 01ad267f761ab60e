// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// How a type's messages are laid out, whose definition has this checksum.
using EncodingOfType = Encoding (*)(const std::string& type, std::string_view md5);

/// Opens a ROS 1 bag without its index, of which every whole record is read: once to find the messages, then in their
/// order. Chunks and other pieces that are damaged are left out; what the index says of chunks tells where to go on.
/// Every length is compared with the bytes that are there before anything is allocated. Memory: 32 bytes a message, at
/// most 640 MB, and up to four chunks. Throws InputError, also where no message is whole. sound: the bag was checked
/// and its index is whole, so that nothing is said of it.
[[nodiscard]] std::unique_ptr<MessageSource> open_unindexed_bag(const std::string& path, EncodingOfType encoding_of,
                                                                bool sound = false);

}  // namespace plumbline::slam
