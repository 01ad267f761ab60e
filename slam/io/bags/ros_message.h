// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"
#include "slam/io/estimate.h"
#include "slam/io/packets/point_cloud.h"
#include "slam/io/records.h"
#include "slam/io/ros2/message_source.h"

// Messages of ROS 1 and 2 as bytes: little endian, texts and lists with their length before them. CDR, of ROS 2, has a
// head of 4 bytes, numbers at multiples of their size from there on, a 0 after each text, and no sequence number. Times
// before 0 are written as 0. What reads throws InputError, without a mark, on bytes that end too early, and
// ImpossibleNumber on numbers that cannot be.
namespace plumbline::slam::ros {

/// A message whose bytes are whole, but whose vector is not finite or whose quaternion is no rotation.
class ImpossibleNumber : public InputError {
  using InputError::InputError;
};

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

/// nav_msgs/OccupancyGrid, whose x and y are those of its frame: cells of a row along x, rows along y.
struct Grid {
  Nanoseconds stamp = 0;
  std::string frame;
  float resolution_m = 0.05F;
  std::uint32_t width = 0, height = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< the corner of the first cell
  std::vector<std::int8_t> cells;                    ///< 0 free, 100 occupied, -1 unknown
};

/// Triangles of one kind and colour.
struct Triangles {
  std::string name;
  std::array<float, 4> colour{0.7F, 0.7F, 0.7F, 1.0F};  ///< red, green, blue, opacity
  std::vector<Eigen::Vector3d> corners;                 ///< three a triangle
};

/// An Imu whose vectors are along the axes of `frame`, not R.
struct FramedImu {
  std::string frame;
  Imu imu;
};

[[nodiscard]] Bytes write_clock(Nanoseconds stamp, Encoding encoding = Encoding::ros1);  ///< rosgraph_msgs/Clock
[[nodiscard]] Bytes write_cloud(const PointCloud& cloud, std::string_view frame,
                                Encoding encoding = Encoding::ros1);  ///< sensor_msgs/PointCloud2
[[nodiscard]] Bytes write_odometry(const OdometryMessage& message,
                                   Encoding encoding = Encoding::ros1);  ///< nav_msgs/Odometry
[[nodiscard]] Bytes write_imu(const Imu& imu, std::string_view frame,
                              Encoding encoding = Encoding::ros1);  ///< sensor_msgs/Imu
[[nodiscard]] Bytes write_transforms(std::span<const Transform> transforms,
                                     Encoding encoding = Encoding::ros1);  ///< tf2_msgs/TFMessage

/// visualization_msgs/MarkerArray: a TRIANGLE_LIST each.
[[nodiscard]] Bytes write_markers(std::span<const Triangles> all, std::string_view frame, Encoding encoding);
[[nodiscard]] Bytes write_grid(const Grid& grid, Encoding encoding);

[[nodiscard]] FramedCloud read_cloud(std::span<const std::uint8_t> bytes, Encoding encoding = Encoding::ros1);
[[nodiscard]] OdometryMessage read_odometry(std::span<const std::uint8_t> bytes, Encoding encoding = Encoding::ros1);
[[nodiscard]] FramedImu read_imu(std::span<const std::uint8_t> bytes, Encoding encoding = Encoding::ros1);
/// tf2_msgs/TFMessage: joints whose numbers are no pose, as of a driver that has not begun, are only counted.
struct Transforms {
  std::vector<Transform> all;
  std::size_t impossible = 0;
};
[[nodiscard]] std::string impossible_transforms(const std::string& topic, std::size_t count);
[[nodiscard]] Transforms read_transforms(std::span<const std::uint8_t> bytes, Encoding encoding = Encoding::ros1);

/// Whether poses of a robot are read from messages of this type: nav_msgs/Odometry, nav_msgs/Path,
/// geometry_msgs/PoseStamped or geometry_msgs/PoseWithCovarianceStamped.
[[nodiscard]] bool holds_poses(std::string_view type);
/// The poses of a message of such a type, many of a Path.
[[nodiscard]] std::vector<StampedPose> read_poses(std::string_view type, std::span<const std::uint8_t> bytes,
                                                  Encoding encoding = Encoding::ros1);

/// livox_ros_driver2/CustomMsg and its older names: points with times from a base in ns. A cloud without rings, since
/// Livox's lines are none, of the time base as its stamp.
[[nodiscard]] FramedCloud read_livox(std::span<const std::uint8_t> bytes, Encoding encoding);

}  // namespace plumbline::slam::ros
