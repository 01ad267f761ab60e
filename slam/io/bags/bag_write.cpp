// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/odometry_motion.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace {

/// A message that is bytes already, with its type as a bag describes it.
struct RawMessage {
  const char* type = nullptr;
  const char* md5 = nullptr;
  const char* definition = nullptr;
  ros::Bytes bytes;
};

/// Bytes of a message of the installed type M.
template <class M>
RawMessage raw(ros::Bytes bytes) {
  namespace traits = ::ros::message_traits;
  return {traits::DataType<M>::value(), traits::MD5Sum<M>::value(), traits::Definition<M>::value(), std::move(bytes)};
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
struct DataType<plumbline::slam::RawMessage> {
  static const char* value(const plumbline::slam::RawMessage& m) { return m.type; }
};
template <>
struct MD5Sum<plumbline::slam::RawMessage> {
  static const char* value(const plumbline::slam::RawMessage& m) { return m.md5; }
};
template <>
struct Definition<plumbline::slam::RawMessage> {
  static const char* value(const plumbline::slam::RawMessage& m) { return m.definition; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<plumbline::slam::RawMessage> {
  template <class Stream>
  static void write(Stream& stream, const plumbline::slam::RawMessage& m) {
    std::copy(m.bytes.begin(), m.bytes.end(), stream.advance(static_cast<std::uint32_t>(m.bytes.size())));
  }
  static std::uint32_t serializedLength(const plumbline::slam::RawMessage& m) {
    return static_cast<std::uint32_t>(m.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace plumbline::slam {

struct BagWriter::Impl {
  std::string path;
  std::string temporary;
  BagProfile profile;
  rosbag::Bag bag;
  bool open = false;
  OdometryMotion motion;

  template <class F>
  void guarded(const F& function) const {
    try {
      function();
    } catch (const ::ros::Exception& error) {
      throw EnvironmentError(path + ": cannot be written: " + error.what());
    }
  }

  /// With a connection header of our own: the library's would hold no caller.
  void write(std::string_view topic, Nanoseconds stamp, const RawMessage& message, bool latching = false) {
    const auto header = boost::make_shared<::ros::M_string>();
    (*header)["callerid"] = "/plumbline";
    (*header)["latching"] = latching ? "1" : "0";
    (*header)["topic"] = topic;
    (*header)["type"] = message.type;
    (*header)["md5sum"] = message.md5;
    (*header)["message_definition"] = message.definition;
    // A bag has no time before 1 ns.
    guarded([&] { bag.write(std::string(topic), ros_time(std::max<Nanoseconds>(stamp, 1)), message, header); });
  }

  void write_transform(std::string_view topic, const ros::Transform& transform, bool latching) {
    write(topic, transform.stamp, raw<tf2_msgs::TFMessage>(ros::write_transforms({&transform, 1})), latching);
  }

  void write_imu(const Imu& imu) {
    write(profile.imu, imu.stamp, raw<sensor_msgs::Imu>(ros::write_imu(imu, profile.base)));
  }

  void write_odometry(const Odometry& record, const std::optional<Matrix6d>& covariance) {
    ros::OdometryMessage message = motion.message(record, covariance);
    message.X_OR.parent = profile.odom;
    message.X_OR.child = profile.base;
    write("/clock", record.stamp, raw<rosgraph_msgs::Clock>(ros::write_clock(record.stamp)));
    write(profile.odometry, record.stamp, raw<nav_msgs::Odometry>(ros::write_odometry(message)));
    write_transform("/tf", message.X_OR, false);
  }
};

BagWriter::BagWriter(const std::string& path, const BagProfile& profile, const Calibration& calibration)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->temporary = path + ".part";
  impl_->profile = profile;
  impl_->guarded([&] {
    impl_->bag.open(impl_->temporary, rosbag::bagmode::Write);
    impl_->bag.setCompression(rosbag::compression::LZ4);
  });
  impl_->open = true;
  impl_->write_transform("/tf_static", {0, std::string(profile.base), std::string(profile.lidar), calibration.X_RL},
                         true);
}

BagWriter::~BagWriter() {
  if (!impl_->open) return;
  try {
    impl_->bag.close();
  } catch (const ::ros::Exception&) {
    // It goes anyway.
  }
  std::remove(impl_->temporary.c_str());
}

void BagWriter::add(const Scan& scan, std::span<const Odometry> odometry, std::span<const Imu> imu,
                    std::span<const OdometryCovariance> covariances) {
  auto next = imu.begin();
  auto known = covariances.begin();
  for (const Odometry& record : odometry) {
    for (; next != imu.end() && next->stamp <= record.stamp; ++next) impl_->write_imu(*next);
    while (known != covariances.end() && known->stamp < record.stamp) ++known;
    const bool found = known != covariances.end() && known->stamp == record.stamp;
    impl_->write_odometry(record, found ? std::optional(known->covariance) : std::nullopt);
  }
  for (; next != imu.end(); ++next) impl_->write_imu(*next);
  const BagProfile& profile = impl_->profile;
  impl_->write(profile.points, scan.stamp,
               raw<sensor_msgs::PointCloud2>(ros::write_cloud(cloud_of(scan, profile.layout), profile.lidar)));
}

void BagWriter::add_truth(std::span<const StampedPose> truth_W) {
  for (const StampedPose& truth : truth_W)
    impl_->write("/ground_truth/odom", truth.stamp,
                 raw<nav_msgs::Odometry>(
                     ros::write_odometry({{truth.stamp, "map", std::string(impl_->profile.base), truth.X_FR}})));
}

void BagWriter::finish() {
  impl_->guarded([&] { impl_->bag.close(); });
  impl_->open = false;
  if (std::rename(impl_->temporary.c_str(), impl_->path.c_str()) == 0) return;
  std::remove(impl_->temporary.c_str());
  throw EnvironmentError(impl_->path + ": cannot be moved into place");
}

}  // namespace plumbline::slam
