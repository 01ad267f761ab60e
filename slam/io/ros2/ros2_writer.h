// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "slam/io/records.h"

namespace plumbline::slam {

/// A topic as ROS 2 bags describe it.
struct Ros2Topic {
  std::string name;
  std::string type;        ///< "sensor_msgs/msg/PointCloud2"
  std::string definition;  ///< of the type and those in it, ros2msg
  std::string qos;         ///< offered_qos_profiles: YAML in a text
};

/// Writes CDR messages into a bag of ROS 2. It is whole after finish(), where it was begun: it is not renamed here.
/// Functions throw EnvironmentError.
class Ros2Writer {
 public:
  virtual ~Ros2Writer() = default;
  [[nodiscard]] virtual std::uint16_t add_topic(const Ros2Topic& topic) = 0;
  /// In the order of time, which must not be before 0.
  virtual void write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr) = 0;
  virtual void finish() = 0;
};

/// An MCAP file [mcap2024], in chunks of 1 MiB, with index, statistics and all checksums, so that players can seek. The
/// same messages give the same bytes. compression: "", "zstd" or "lz4"; the bytes of these depend on the library's
/// version. Throws EnvironmentError.
[[nodiscard]] std::unique_ptr<Ros2Writer> make_mcap_writer(const std::string& path, std::string_view compression);

/// A rosbag2 folder, which must not exist: NAME_0.db3 with the SQLite schema of Humble, which later releases read as
/// well, and metadata.yaml. The same messages give the same bytes with the same version of SQLite. Throws
/// EnvironmentError.
[[nodiscard]] std::unique_ptr<Ros2Writer> make_rosbag2_writer(const std::string& folder, const std::string& name);

}  // namespace plumbline::slam
