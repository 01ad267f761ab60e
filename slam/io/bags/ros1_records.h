// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"

/// Records of a ROS 1 bag [rosbag2010]. Functions throw InputError without a mark.
namespace plumbline::slam::ros1 {

inline constexpr std::uint64_t first_record = 13;  ///< after "#ROSBAG V2.0\n"
inline constexpr std::uint64_t most_header_bytes = std::uint64_t{1} << 20U;
inline constexpr std::uint64_t most_chunk_bytes = std::uint64_t{1} << 28U;

/// Kinds of records.
enum class Op : unsigned char { message = 2, bag = 3, index = 4, chunk = 5, chunk_info = 6, connection = 7 };

using Fields = std::map<std::string, std::string_view, std::less<>>;

template <class T>
[[nodiscard]] T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));  // little endian, as every CPU that this is built for
  return value;
}

/// "name=value" each, its length before it.
[[nodiscard]] Fields fields_of(std::string_view header);
[[nodiscard]] std::string_view text_of(const Fields& fields, std::string_view name);

template <class T>
[[nodiscard]] T value_of(const Fields& fields, std::string_view name) {
  const std::string_view text = text_of(fields, name);
  if (text.size() != sizeof(T)) throw InputError({}, "a header whose '" + std::string(name) + "' has another length");
  return number_at<T>(text, 0);
}

[[nodiscard]] inline Op op_of(const Fields& fields) { return static_cast<Op>(value_of<unsigned char>(fields, "op")); }

struct Record {
  Fields fields;
  std::string_view data;
  std::uint64_t bytes = 0;  ///< with its lengths
};

/// The record of a chunk that begins there: a message or a connection.
[[nodiscard]] Record record_at(std::string_view chunk, std::size_t at);

/// What a chunk with this header holds; the buffer keeps it where it was packed. Throws before it allocates where the
/// bytes cannot hold what the header says.
[[nodiscard]] std::string_view unpack_chunk(const Fields& fields, std::vector<char>& packed, std::vector<char>& buffer);

/// Whether rosbag unpacks this chunk, too: it knows one kind of lz4 frame, other programs write all kinds.
[[nodiscard]] bool rosbag_unpacks(const Fields& fields, const std::vector<char>& packed);

}  // namespace plumbline::slam::ros1
