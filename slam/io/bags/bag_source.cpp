// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_source.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "bim/config/input_file.h"
#include "slam/io/bags/ros1_source.h"
#include "slam/io/ros2/bag_files.h"
#include "slam/io/ros2/mcap_format.h"
#include "slam/io/ros2/mcap_reader.h"
#include "slam/io/ros2/rosbag2_reader.h"

namespace plumbline::slam {

namespace {

enum class Kind { none, ros1, mcap, database, folder };

Kind kind_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const std::string metadata = path + "/metadata.yaml";
    if (!fs::exists(metadata, error)) return find_bag_files(path).names.empty() ? Kind::none : Kind::folder;
    constexpr std::uint64_t most_metadata_bytes = 16U << 20U;
    return read_text_file(metadata, most_metadata_bytes).find("rosbag2_bagfile_information") != std::string::npos
               ? Kind::folder
               : Kind::none;
  }
  if (!fs::is_regular_file(path, error)) return Kind::none;
  const InputFile file = open_input_file(path);
  std::array<char, 16> start{};
  const std::string_view bytes(start.data(), std::fread(start.data(), 1, start.size(), file.stream.get()));
  if (bytes.starts_with("#ROSBAG V2.0")) return Kind::ros1;
  if (bytes.starts_with(std::string_view("SQLite format 3", 16))) return Kind::database;
  const std::string_view mcap(reinterpret_cast<const char*>(mcap::magic.data()), mcap::magic.size());
  return bytes.starts_with(mcap) ? Kind::mcap : Kind::none;
}

}  // namespace

std::unique_ptr<MessageSource> open_source(const std::string& path) {
  switch (kind_of(path)) {
    case Kind::mcap:
      return open_mcap(path);
    case Kind::database:
      return open_rosbag2_database(path);
    case Kind::folder:
      return open_rosbag2_folder(path);
    case Kind::ros1:
    case Kind::none:
      break;
  }
  return open_ros1_bag(path);
}

bool is_bag(const std::string& path) { return kind_of(path) != Kind::none; }

}  // namespace plumbline::slam
