// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

enum class MessageType { clock, cloud, odometry, imu, transforms, markers, grid };

/// A bag that is being written. Markers and grids are of ROS 2 alone. Functions throw EnvironmentError.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  /// How messages are to be laid out.
  [[nodiscard]] virtual Encoding encoding() const = 0;
  /// latched: who listens later gets it all the same.
  virtual void write(std::string_view topic, MessageType type, Nanoseconds stamp, const ros::Bytes& bytes,
                     bool latched) = 0;
  virtual void finish() = 0;
};

[[nodiscard]] std::unique_ptr<MessageSink> make_ros1_sink(const std::string& path);
/// compression: "", "zstd" or "lz4".
[[nodiscard]] std::unique_ptr<MessageSink> make_mcap_sink(const std::string& path, std::string_view compression);
/// path: the folder to make. name: of the files in it.
[[nodiscard]] std::unique_ptr<MessageSink> make_rosbag2_sink(const std::string& path, const std::string& name);

}  // namespace plumbline::slam
