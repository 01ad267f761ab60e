// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// Opens an MCAP file [mcap2024]: every length in it is compared with the bytes that are there before anything is
/// allocated, every checksum of a chunk that is read is checked. Memory: the chunks that overlap in time, at most 1 GiB
/// unless one alone is larger, and a packed one. open_bytes: of all files of a split bag, which share the limit. Of a
/// file that was not closed all whole records are read, after one pass for what it holds, and of one with damaged
/// chunks all whole ones; left_out() tells, once all is read. Throws InputError.
[[nodiscard]] std::unique_ptr<MessageSource> open_mcap(const std::string& path,
                                                       std::shared_ptr<std::size_t> open_bytes = nullptr);

}  // namespace plumbline::slam
