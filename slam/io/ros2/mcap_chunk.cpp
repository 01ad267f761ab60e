// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_chunk.h"

#include <zlib.h>

#include <algorithm>
#include <optional>
#include <string>

#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/mcap_values.h"

namespace plumbline::slam::mcap {

namespace {

struct ChunkHead {
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;
  std::string compression;
  std::uint64_t packed_bytes = 0;
};

ChunkHead chunk_head(Values& values) {
  static_cast<void>(values.take(16));  // times of the first and the last message
  ChunkHead head;
  head.unpacked_bytes = values.number<std::uint64_t>();
  head.crc = values.number<std::uint32_t>();
  head.compression = values.text();
  head.packed_bytes = values.number<std::uint64_t>();
  return head;
}

}  // namespace

std::uint32_t checksum(std::uint32_t before, std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

std::vector<std::uint8_t> records_of_chunk(std::span<const std::uint8_t> content) {
  Values values(content);
  const ChunkHead head = chunk_head(values);
  std::vector<std::uint8_t> chunk = unpack(head.compression, values.take(head.packed_bytes), head.unpacked_bytes);
  if (head.crc != 0 && checksum(0, chunk) != head.crc) throw InputError({}, "a chunk whose checksum is wrong");
  return chunk;
}

std::vector<std::uint8_t> records_of_cut_chunk(std::span<const std::uint8_t> content) {
  Values values(content);
  const ChunkHead head = chunk_head(values);
  const auto packed = values.rest().first(std::min<std::uint64_t>(values.rest().size(), head.packed_bytes));
  std::vector<std::uint8_t> chunk = unpack_beginning(head.compression, packed, head.unpacked_bytes);
  std::size_t whole = 0;
  while (whole + head_bytes <= chunk.size()) {
    const Head record = head_of(std::span(chunk).subspan(whole));
    if (record.op == Op::none || record.size > chunk.size() - whole - head_bytes) break;
    whole += head_bytes + record.size;
  }
  chunk.resize(whole);
  return chunk;
}

std::size_t count_messages(std::span<const std::uint8_t> records) {
  std::size_t count = 0;
  for (std::uint64_t at = 0; at < records.size();) {
    const Head head = record_in(records, at).first;
    count += head.op == Op::message ? 1 : 0;
    at += head_bytes + head.size;
  }
  return count;
}

Nanoseconds time_of(std::span<const std::uint8_t> message) {
  constexpr std::uint64_t channel_and_number = 6;
  Values values(message);
  static_cast<void>(values.take(channel_and_number));
  return static_cast<Nanoseconds>(values.number<std::uint64_t>());
}

Nanoseconds first_time(std::span<const std::uint8_t> records) {
  std::optional<Nanoseconds> first;
  for (std::size_t at = 0; at < records.size();) {
    const auto [head, content] = record_in(records, at);
    if (head.op == Op::message) first = std::min(first.value_or(time_of(content)), time_of(content));
    at += head_bytes + head.size;
  }
  return first.value_or(0);
}

}  // namespace plumbline::slam::mcap
