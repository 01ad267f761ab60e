// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"

namespace plumbline::slam {

/// Of a bag whose index is not there or not whole, since it was not closed or is cut off.
struct NoIndex : InputError {
  using InputError::InputError;
};

/// Reads a ROS 1 bag [rosbag2010] through once and compares every length, count and offset in it with the bytes that
/// are there, since rosbag believes them: those of records, of the index, and of messages in chunks, which are unpacked
/// one after the other. Memory: that of the largest chunk, 256 MB at most. Throws InputError with the place of the
/// record that is wrong, also where the bag is encrypted, and NoIndex where it was not closed. False: rosbag cannot
/// unpack its chunks, although they are sound.
[[nodiscard]] bool check_bag(const std::string& path);

}  // namespace plumbline::slam
