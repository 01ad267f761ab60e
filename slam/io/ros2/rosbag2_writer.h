// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "slam/io/ros2/mcap_writer.h"

namespace plumbline::slam {

/// Writes a rosbag2 folder: NAME_0.db3 with the SQLite schema of Humble, which later releases read as well, and
/// metadata.yaml. The same messages give the same bytes with the same version of SQLite. Throws EnvironmentError.
class Rosbag2Writer {
 public:
  /// Makes the folder, which must not exist. name: of the files in it.
  Rosbag2Writer(const std::string& folder, const std::string& name);
  ~Rosbag2Writer();
  Rosbag2Writer(const Rosbag2Writer&) = delete;
  Rosbag2Writer& operator=(const Rosbag2Writer&) = delete;

  [[nodiscard]] std::uint16_t add_topic(const Ros2Topic& topic);
  void write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::slam
