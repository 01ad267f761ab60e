// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include "slam/io/bags/message_sink.h"
#include "slam/io/bags/ros2_definitions.h"
#include "slam/io/ros2/ros2_writer.h"

namespace plumbline::slam {

namespace {

/// CDR into a file format of ROS 2.
class Ros2Sink final : public MessageSink {
 public:
  explicit Ros2Sink(std::unique_ptr<Ros2Writer> file) : file_(std::move(file)) {}

  [[nodiscard]] Encoding encoding() const override { return Encoding::cdr; }

  void write(std::string_view topic, MessageType type, Nanoseconds stamp, const ros::Bytes& bytes,
             bool latched) override {
    auto known = topics_.find(topic);
    if (known == topics_.end()) {
      const Ros2Topic described{std::string(topic), ros2_type(type), ros2_definition(type), ros2_qos(latched)};
      known = topics_.emplace(topic, file_->add_topic(described)).first;
    }
    file_->write(known->second, stamp, bytes);
  }
  void finish() override { file_->finish(); }

 private:
  std::unique_ptr<Ros2Writer> file_;
  std::map<std::string, std::uint16_t, std::less<>> topics_;
};

}  // namespace

std::unique_ptr<MessageSink> make_mcap_sink(const std::string& path, std::string_view compression) {
  return std::make_unique<Ros2Sink>(make_mcap_writer(path, compression));
}

std::unique_ptr<MessageSink> make_rosbag2_sink(const std::string& path, const std::string& name) {
  return std::make_unique<Ros2Sink>(make_rosbag2_writer(path, name));
}

}  // namespace plumbline::slam
