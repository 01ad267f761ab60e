// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <functional>
#include <string>

#include "slam/io/bags/message_sink.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"

namespace plumbline::slam {

/// Changes of the messages of a walk before they are written, each given the number of the message on its topic.
struct Alteration {
  std::function<void(int, PointCloud&)> cloud = [](int, PointCloud&) {};
  std::function<void(int, ros::OdometryMessage&)> odometry = [](int, ros::OdometryMessage&) {};
  std::function<void(int, ros::FramedImu&)> imu = [](int, ros::FramedImu&) {};
  std::function<std::string(int)> cloud_frame = [](int) { return "velodyne"; };
  bool has_odometry = true;
  std::string transforms = "/tf_static";  ///< topic on which the mount is published with every scan
  std::function<Pose(int)> mount = [](int) { return Pose{}; };
};

/// Writes the walk of four scans, recorded in the order of its own stamps, as a rosbag2.
inline void write_altered(const std::string& path, const Alteration& alteration) {
  const auto sink = make_rosbag2_sink(path, "walk");
  int clouds = 0, odometry = 0, imu = 0;
  for (const SensorFrame& frame : walk_of_four_scans()) {
    const ros::Transform mount{0, "base_link", "velodyne", alteration.mount(clouds)};
    sink->write(alteration.transforms, MessageType::transforms, frame.scan.stamp,
                ros::write_transforms({&mount, 1}, Encoding::cdr), true);
    for (const Odometry& record : frame.odometry) {
      if (!alteration.has_odometry) continue;
      ros::OdometryMessage message{{record.stamp, "odom", "base_link", record.X_OR}};
      alteration.odometry(odometry++, message);
      sink->write("/odom", MessageType::odometry, record.stamp, ros::write_odometry(message, Encoding::cdr), false);
    }
    for (const Imu& record : frame.imu) {
      ros::FramedImu message{"base_link", record};
      alteration.imu(imu++, message);
      sink->write("/imu/data", MessageType::imu, record.stamp,
                  ros::write_imu(message.imu, message.frame, Encoding::cdr), false);
    }
    PointCloud cloud = cloud_of(frame.scan, CloudLayout::organised);
    const std::string cloud_frame = alteration.cloud_frame(clouds);
    alteration.cloud(clouds++, cloud);
    sink->write("/velodyne_points", MessageType::cloud, frame.scan.stamp,
                ros::write_cloud(cloud, cloud_frame, Encoding::cdr), false);
  }
  sink->finish();
}

/// Calls change(number) with the f32 or u16 at `offset` of every point.
template <class T>
void change_field(PointCloud& cloud, std::size_t offset, const std::function<T(T)>& change) {
  for (std::size_t at = offset; at < cloud.data.size(); at += cloud.point_step) {
    T value;
    std::memcpy(&value, &cloud.data[at], sizeof value);
    value = change(value);
    std::memcpy(&cloud.data[at], &value, sizeof value);
  }
}

inline constexpr std::size_t ring_offset = 16, time_offset = 18;  ///< of an organised cloud's points

}  // namespace plumbline::slam
