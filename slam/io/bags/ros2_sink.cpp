// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "slam/io/bags/message_sink.h"
#include "slam/io/bags/ros2_definitions.h"
#include "slam/io/ros2/mcap_writer.h"
#include "slam/io/ros2/rosbag2_writer.h"

namespace plumbline::slam {

namespace {

/// CDR into a file format of ROS 2.
template <class File>
class Ros2Sink final : public MessageSink {
 public:
  template <class... Arguments>
  explicit Ros2Sink(const Arguments&... arguments) : file_(arguments...) {}

  [[nodiscard]] Encoding encoding() const override { return Encoding::cdr; }

  void write(std::string_view topic, MessageType type, Nanoseconds stamp, const ros::Bytes& bytes,
             bool latched) override {
    auto known = topics_.find(topic);
    if (known == topics_.end()) {
      const Ros2Topic described{std::string(topic), ros2_type(type), ros2_definition(type), ros2_qos(latched)};
      known = topics_.emplace(topic, file_.add_topic(described)).first;
    }
    file_.write(known->second, stamp, bytes);
  }
  void finish() override { file_.finish(); }

 private:
  File file_;
  std::map<std::string, std::uint16_t, std::less<>> topics_;
};

}  // namespace

std::unique_ptr<MessageSink> make_mcap_sink(const std::string& path, std::string_view compression) {
  return std::make_unique<Ros2Sink<McapWriter>>(path, compression);
}

std::unique_ptr<MessageSink> make_rosbag2_sink(const std::string& path, const std::string& name) {
  return std::make_unique<Ros2Sink<Rosbag2Writer>>(path, name);
}

}  // namespace plumbline::slam
