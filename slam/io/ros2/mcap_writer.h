// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// A topic as ROS 2 bags describe it.
struct Ros2Topic {
  std::string name;
  std::string type;        ///< "sensor_msgs/msg/PointCloud2"
  std::string definition;  ///< of the type and those in it, ros2msg
  std::string qos;         ///< offered_qos_profiles: YAML in a text
};

/// Writes an MCAP file [mcap2024] of CDR messages in chunks of 1 MiB, with index, statistics and all checksums, so that
/// players can seek. The same messages give the same bytes. The file at `path` is not renamed here: it is whole after
/// finish(). Throws EnvironmentError.
class McapWriter {
 public:
  /// compression: "", "zstd" or "lz4"; the bytes of these depend on the library's version.
  McapWriter(const std::string& path, std::string_view compression);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  [[nodiscard]] std::uint16_t add_topic(const Ros2Topic& topic);
  /// In the order of time, which must not be before 0.
  void write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::slam
