// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/ros1_records.h"

#include <bzlib.h>

#include "slam/io/ros2/compression.h"

namespace plumbline::slam::ros1 {

Fields fields_of(std::string_view header) {
  Fields fields;
  while (!header.empty()) {
    if (header.size() < 4) throw InputError({}, "a header that ends in the middle of a field");
    const auto length = number_at<std::uint32_t>(header, 0);
    header.remove_prefix(4);
    const std::string_view field = header.substr(0, length);
    const std::size_t equals = field.find('=');
    if (field.size() != length || equals == std::string_view::npos)
      throw InputError({}, "a header with a field that is longer than the header, or is none");
    fields.insert_or_assign(std::string(field.substr(0, equals)), field.substr(equals + 1));
    header.remove_prefix(length);
  }
  return fields;
}

std::string_view text_of(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw InputError({}, "a header without '" + std::string(name) + "'");
  return found->second;
}

Record record_at(std::string_view chunk, std::size_t at) {
  const std::string_view rest = chunk.substr(at);
  const auto fail = [] { throw InputError({}, "a chunk with a record that is longer than the chunk"); };
  if (rest.size() < 8) fail();
  const std::uint64_t header = number_at<std::uint32_t>(rest, 0);
  if (header > rest.size() - 8) fail();
  const std::uint64_t data = number_at<std::uint32_t>(rest, 4 + header);
  if (data > rest.size() - 8 - header) fail();
  Record record{fields_of(rest.substr(4, header)), rest.substr(8 + header, data), 8 + header + data};
  const Op op = op_of(record.fields);
  if (op != Op::message && op != Op::connection)
    throw InputError({}, "a chunk with a record of another kind than messages");
  (void)value_of<std::uint32_t>(record.fields, "conn");
  if (op == Op::message)
    (void)value_of<std::uint64_t>(record.fields, "time");
  else
    (void)text_of(record.fields, "topic");
  return record;
}

std::string_view unpack_chunk(const Fields& fields, std::vector<char>& packed, std::vector<char>& buffer) {
  constexpr std::uint64_t most_lz4 = 255;  // times smaller
  const std::string compression(text_of(fields, "compression"));
  const std::uint64_t size = value_of<std::uint32_t>(fields, "size");
  if (size > most_chunk_bytes)
    throw InputError(
        {}, "a chunk of " + std::to_string(size) + " bytes; at most " + std::to_string(most_chunk_bytes) + " are read");
  if ((compression == "none" && size != packed.size()) || (compression == "lz4" && size > most_lz4 * packed.size()))
    throw InputError(
        {}, "a chunk of " + std::to_string(packed.size()) + " bytes that says it holds " + std::to_string(size));
  if (compression == "none") return {packed.data(), packed.size()};
  buffer.resize(static_cast<std::size_t>(size));
  auto got = static_cast<unsigned>(size);
  const auto from = static_cast<unsigned>(packed.size());
  if (compression == "lz4") {
    unpack_lz4({reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size()},
               {reinterpret_cast<std::uint8_t*>(buffer.data()), buffer.size()});
  } else if (compression == "bz2") {
    if (BZ2_bzBuffToBuffDecompress(buffer.data(), &got, packed.data(), from, 0, 0) != BZ_OK || got != size)
      throw InputError({}, "a chunk that cannot be unpacked");
  } else {
    throw InputError({}, "a chunk packed by '" + compression.substr(0, 40) + "'; lz4, bz2 or none would be right");
  }
  return {buffer.data(), buffer.size()};
}

bool rosbag_unpacks(const Fields& fields, const std::vector<char>& packed) {
  constexpr std::size_t options_at = 4;
  constexpr char only_options = 0x64;  // version 1, independent blocks, a checksum of the content, nothing else
  return text_of(fields, "compression") != "lz4" || (packed.size() > options_at && packed[options_at] == only_options);
}

}  // namespace plumbline::slam::ros1
