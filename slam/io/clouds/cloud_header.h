// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace plumbline::slam {

enum class CloudFormat { pcd, ply };

/// What follows a header. compressed: of PCD only.
enum class CloudData { ascii, binary, compressed };

/// What a file says that it holds.
struct CloudHeader {
  CloudFormat format = CloudFormat::pcd;
  CloudData data = CloudData::ascii;
  std::uint32_t width = 0;    ///< points a row
  std::uint32_t height = 0;   ///< rows
  std::uint32_t numbers = 0;  ///< a point has
  std::uint32_t step = 0;     ///< bytes a point takes when it is binary
  std::size_t size = 0;       ///< bytes of the header itself, line break included

  [[nodiscard]] std::uint64_t points() const { return std::uint64_t{width} * height; }
};

/// Header of a PCD file (0.6 or 0.7) or of a PLY file (ASCII, or binary and little endian, with vertices of plain
/// numbers and nothing else but PCL's camera) at the beginning of `bytes`, which are the whole file. What it promises
/// fits the file: no reader that believes it allocates more than the file is worth. Throws InputError, also beyond 4
/// million points, 1 GiB or 63 fields, without x, y and z, and where the file is too short for its points.
[[nodiscard]] CloudHeader read_cloud_header(std::string_view bytes, CloudFormat format, const std::string& file);

/// By the file's ending, .pcd or .ply. Throws InputError for any other.
[[nodiscard]] CloudFormat cloud_format_of(const std::string& file);
/// Whether the file's ending is one of these.
[[nodiscard]] bool is_cloud_file(std::string_view file);

}  // namespace plumbline::slam
