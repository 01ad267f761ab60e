// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::slam {

/// Reads a ROS 1 bag [rosbag2010] through once and compares every length, count and offset in it with the bytes that
/// are there, since rosbag believes them: those of records, of the index, and of messages in chunks, which are unpacked
/// one after the other. Memory: that of the largest chunk, 256 MB at most. Throws InputError with the place of the
/// record that is wrong, also where the bag was not closed or is encrypted.
void check_bag(const std::string& path);

}  // namespace plumbline::slam
