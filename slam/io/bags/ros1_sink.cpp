// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "bim/errors.h"
#include "slam/io/bags/message_sink.h"

namespace plumbline::slam {

namespace {

/// A message that is bytes already, with its type as a bag describes it.
struct TypedBytes {
  const char* type = nullptr;
  const char* md5 = nullptr;
  const char* definition = nullptr;
  ros::Bytes bytes;
};

/// Bytes of a message of the installed type M.
template <class M>
TypedBytes typed(const ros::Bytes& bytes) {
  namespace traits = ::ros::message_traits;
  return {traits::DataType<M>::value(), traits::MD5Sum<M>::value(), traits::Definition<M>::value(), bytes};
}

TypedBytes typed(MessageType type, const ros::Bytes& bytes) {
  switch (type) {
    case MessageType::clock:
      return typed<rosgraph_msgs::Clock>(bytes);
    case MessageType::cloud:
      return typed<sensor_msgs::PointCloud2>(bytes);
    case MessageType::odometry:
      return typed<nav_msgs::Odometry>(bytes);
    case MessageType::imu:
      return typed<sensor_msgs::Imu>(bytes);
    case MessageType::transforms:
      return typed<tf2_msgs::TFMessage>(bytes);
    case MessageType::markers:
    case MessageType::grid:
      break;
  }
  throw InternalError("unknown type of message");
}

::ros::Time ros_time(Nanoseconds t) {
  ::ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::max<Nanoseconds>(t, 0)));
  return time;
}

}  // namespace
}  // namespace plumbline::slam

// Traits that rosbag needs of a message.
namespace ros {
namespace message_traits {
template <>
struct DataType<plumbline::slam::TypedBytes> {
  static const char* value(const plumbline::slam::TypedBytes& m) { return m.type; }
};
template <>
struct MD5Sum<plumbline::slam::TypedBytes> {
  static const char* value(const plumbline::slam::TypedBytes& m) { return m.md5; }
};
template <>
struct Definition<plumbline::slam::TypedBytes> {
  static const char* value(const plumbline::slam::TypedBytes& m) { return m.definition; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<plumbline::slam::TypedBytes> {
  template <class Stream>
  static void write(Stream& stream, const plumbline::slam::TypedBytes& m) {
    std::copy(m.bytes.begin(), m.bytes.end(), stream.advance(static_cast<std::uint32_t>(m.bytes.size())));
  }
  static std::uint32_t serializedLength(const plumbline::slam::TypedBytes& m) {
    return static_cast<std::uint32_t>(m.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace plumbline::slam {

namespace {

class Ros1Sink final : public MessageSink {
 public:
  explicit Ros1Sink(const std::string& path) : path_(path) {
    guarded([&] {
      bag_.open(path, rosbag::bagmode::Write);
      bag_.setCompression(rosbag::compression::LZ4);
    });
    open_ = true;
  }
  ~Ros1Sink() override {
    if (!open_) return;
    try {
      bag_.close();
    } catch (const ::ros::Exception&) {
      // It goes anyway.
    }
  }
  Ros1Sink(const Ros1Sink&) = delete;
  Ros1Sink(Ros1Sink&&) = delete;
  Ros1Sink& operator=(const Ros1Sink&) = delete;
  Ros1Sink& operator=(Ros1Sink&&) = delete;

  [[nodiscard]] Encoding encoding() const override { return Encoding::ros1; }

  /// With a connection header of our own: the library's would hold no caller.
  void write(std::string_view topic, MessageType type, Nanoseconds stamp, const ros::Bytes& bytes,
             bool latched) override {
    const TypedBytes message = typed(type, bytes);
    const auto header = boost::make_shared<::ros::M_string>();
    (*header)["callerid"] = "/plumbline";
    (*header)["latching"] = latched ? "1" : "0";
    (*header)["topic"] = topic;
    (*header)["type"] = message.type;
    (*header)["md5sum"] = message.md5;
    (*header)["message_definition"] = message.definition;
    guarded([&] { bag_.write(std::string(topic), ros_time(stamp), message, header); });
  }

  void finish() override {
    guarded([&] { bag_.close(); });
    open_ = false;
  }

 private:
  template <class F>
  void guarded(const F& function) const {
    try {
      function();
    } catch (const ::ros::Exception& error) {
      throw EnvironmentError(path_ + ": cannot be written: " + error.what());
    }
  }

  std::string path_;
  rosbag::Bag bag_;
  bool open_ = false;
};

}  // namespace

std::unique_ptr<MessageSink> make_ros1_sink(const std::string& path) { return std::make_unique<Ros1Sink>(path); }

}  // namespace plumbline::slam
