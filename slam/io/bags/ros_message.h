// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/packets/point_cloud.h"
#include "slam/io/records.h"

// Messages of ROS 1 as bytes: little endian, texts and lists with their length before them. Times before 0 are written
// as 0. What reads throws InputError, without a mark, on bytes that end too early or numbers that cannot be.
namespace plumbline::slam::ros {

using Bytes = std::vector<std::uint8_t>;

/// A pose of one frame in another at a time.
struct Transform {
  Nanoseconds stamp = 0;
  std::string parent, child;
  Pose X;  ///< of child in parent
};

/// nav_msgs/Odometry. Covariances are of x, y, z and the rotation about them; zero where they are not known.
struct OdometryMessage {
  Transform X_OR;
  Matrix6d pose_covariance = Matrix6d::Zero();   ///< along and about the axes of O
  Vector6d twist = Vector6d::Zero();             ///< in R: m/s, rad/s
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< in R
};

/// A cloud with the frame its points are in.
struct FramedCloud {
  std::string frame;
  PointCloud cloud;
};

/// An Imu whose vectors are along the axes of `frame`, not R.
struct FramedImu {
  std::string frame;
  Imu imu;
};

[[nodiscard]] Bytes write_clock(Nanoseconds stamp);                                ///< rosgraph_msgs/Clock
[[nodiscard]] Bytes write_cloud(const PointCloud& cloud, std::string_view frame);  ///< sensor_msgs/PointCloud2
[[nodiscard]] Bytes write_odometry(const OdometryMessage& message);                ///< nav_msgs/Odometry
[[nodiscard]] Bytes write_imu(const Imu& imu, std::string_view frame);             ///< sensor_msgs/Imu
[[nodiscard]] Bytes write_transforms(std::span<const Transform> transforms);       ///< tf2_msgs/TFMessage

[[nodiscard]] FramedCloud read_cloud(std::span<const std::uint8_t> bytes);
[[nodiscard]] OdometryMessage read_odometry(std::span<const std::uint8_t> bytes);
[[nodiscard]] FramedImu read_imu(std::span<const std::uint8_t> bytes);
[[nodiscard]] std::vector<Transform> read_transforms(std::span<const std::uint8_t> bytes);

}  // namespace plumbline::slam::ros
