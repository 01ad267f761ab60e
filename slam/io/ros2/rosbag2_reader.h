// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// Opens the SQLite file of a rosbag2. zstd: whether each message is a zstd frame (compression_mode MESSAGE). The file
/// is never written, nor is anything run that is stored in it; messages above 256 MiB are refused. Of a file
/// that is cut off or damaged the messages are read that can be found, at 24 bytes each. Throws InputError.
[[nodiscard]] std::unique_ptr<MessageSource> open_rosbag2_database(const std::string& path, bool zstd = false);

/// Opens a rosbag2 folder by its metadata.yaml: the files that it names, in SQLite or MCAP, as one; without it, those
/// of find_bag_files(). Throws InputError, also where a file is missing, stands elsewhere than in the folder, or is
/// compressed as a whole.
[[nodiscard]] std::unique_ptr<MessageSource> open_rosbag2_folder(const std::string& folder);

}  // namespace plumbline::slam
