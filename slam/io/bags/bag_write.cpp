// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <optional>

#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/building_view.h"
#include "slam/io/bags/message_sink.h"
#include "slam/io/bags/odometry_motion.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

std::unique_ptr<MessageSink> make_sink(const std::string& path, const std::string& name, BagFormat format,
                                       std::string_view compression) {
  switch (format) {
    case BagFormat::ros1:
      return make_ros1_sink(path);
    case BagFormat::mcap:
      return make_mcap_sink(path, compression);
    case BagFormat::rosbag2:
      return make_rosbag2_sink(path, name);
  }
  throw InternalError("unknown format of a bag");
}

}  // namespace

struct BagWriter::Impl {
  std::string path;
  std::string temporary;
  BagProfile profile;
  std::unique_ptr<MessageSink> sink;  ///< none once it is finished
  Encoding encoding = Encoding::ros1;
  OdometryMotion motion;

  /// A bag has no time before 1 ns.
  void write(std::string_view topic, MessageType type, Nanoseconds stamp, const ros::Bytes& bytes,
             bool latched = false) {
    sink->write(topic, type, std::max<Nanoseconds>(stamp, 1), bytes, latched);
  }

  void write_transform(std::string_view topic, const ros::Transform& transform, bool latched) {
    write(topic, MessageType::transforms, transform.stamp, ros::write_transforms({&transform, 1}, encoding), latched);
  }

  void write_imu(const Imu& imu) {
    write(profile.imu, MessageType::imu, imu.stamp, ros::write_imu(imu, profile.base, encoding));
  }

  void write_odometry(const Odometry& record, const std::optional<Matrix6d>& covariance) {
    ros::OdometryMessage message = motion.message(record, covariance);
    message.X_OR.parent = profile.odom;
    message.X_OR.child = profile.base;
    write("/clock", MessageType::clock, record.stamp, ros::write_clock(record.stamp, encoding));
    write(profile.odometry, MessageType::odometry, record.stamp, ros::write_odometry(message, encoding));
    write_transform("/tf", message.X_OR, false);
  }
};

BagWriter::BagWriter(const std::string& path, const BagProfile& profile, const Calibration& calibration,
                     BagFormat format, std::string_view compression)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->temporary = path + ".part";
  impl_->profile = profile;
  impl_->sink = make_sink(impl_->temporary, fs::path(path).filename().string(), format, compression);
  impl_->encoding = impl_->sink->encoding();
  impl_->write_transform("/tf_static", {0, std::string(profile.base), std::string(profile.lidar), calibration.X_RL},
                         true);
}

BagWriter::~BagWriter() {
  if (!impl_->sink) return;
  impl_->sink.reset();
  std::error_code error;
  fs::remove_all(impl_->temporary, error);
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
  impl_->write(profile.points, MessageType::cloud, scan.stamp,
               ros::write_cloud(cloud_of(scan, profile.layout), profile.lidar, impl_->encoding));
}

void BagWriter::add_building(const ros::BuildingView& view) {
  if (impl_->encoding != Encoding::cdr) return;
  impl_->write("/building", MessageType::markers, 0, ros::write_markers(view.parts, "map", impl_->encoding), true);
  if (!view.plan.cells.empty())
    impl_->write("/map", MessageType::grid, 0, ros::write_grid(view.plan, impl_->encoding), true);
}

void BagWriter::add_truth(std::span<const StampedPose> truth_W) {
  for (const StampedPose& truth : truth_W)
    impl_->write(
        "/ground_truth/odom", MessageType::odometry, truth.stamp,
        ros::write_odometry({{truth.stamp, "map", std::string(impl_->profile.base), truth.X_FR}}, impl_->encoding));
}

void BagWriter::finish() {
  impl_->sink->finish();
  std::error_code error;
  fs::rename(impl_->temporary, impl_->path, error);
  if (error) throw EnvironmentError(impl_->path + ": cannot be moved into place: " + error.message());
  impl_->sink.reset();
}

}  // namespace plumbline::slam
