// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/io/records.h"

/// Chunks of an MCAP file [mcap2024]. Functions throw InputError without a mark.
namespace plumbline::slam::mcap {

/// As zlib's crc32; before: that of the bytes before these.
[[nodiscard]] std::uint32_t checksum(std::uint32_t before, std::span<const std::uint8_t> bytes);

/// Records of a chunk, whose content this is; their checksum is compared where it has one.
[[nodiscard]] std::vector<std::uint8_t> records_of_chunk(std::span<const std::uint8_t> content);

/// Whole records of a chunk whose content is cut off. Nothing tells whether they are damaged.
[[nodiscard]] std::vector<std::uint8_t> records_of_cut_chunk(std::span<const std::uint8_t> content);

/// How many messages these records hold.
[[nodiscard]] std::size_t count_messages(std::span<const std::uint8_t> records);

/// Time of a message, whose content this is.
[[nodiscard]] Nanoseconds time_of(std::span<const std::uint8_t> message);

/// Of the earliest message; 0 where the records hold none.
[[nodiscard]] Nanoseconds first_time(std::span<const std::uint8_t> records);

}  // namespace plumbline::slam::mcap
