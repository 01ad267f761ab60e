// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "slam/io/estimate.h"
#include "slam/io/packets/point_cloud.h"
#include "slam/io/recordings/recording.h"

namespace plumbline::slam {

namespace ros {
struct BuildingView;
}

/// Names and forms that a family of programs expects in a bag.
struct BagProfile {
  std::string_view name;
  std::string_view points, odometry, imu;  ///< topics
  std::string_view odom, base, lidar;      ///< frames
  CloudLayout layout = CloudLayout::organised;
};

/// velodyne: as its ROS driver and hdl_graph_slam; s_graphs: as lidar_situational_graphs; kiss: dense clouds, for
/// KISS-ICP and others that want no not-a-number.
inline constexpr std::array<BagProfile, 3> bag_profiles = {{
    {"velodyne", "/velodyne_points", "/odom", "/imu/data", "odom", "base_link", "velodyne", CloudLayout::organised},
    {"s_graphs", "/platform/velodyne_points", "/platform/odometry", "/imu/data", "odom", "body", "velodyne",
     CloudLayout::organised},
    {"kiss", "/points", "/odom", "/imu/data", "odom", "base_link", "lidar", CloudLayout::dense},
}};

/// ros1: a ROS 1 bag (LZ4). mcap: an MCAP file as ROS 2 records. rosbag2: a folder with an SQLite file.
enum class BagFormat { ros1, mcap, rosbag2 };

/// Writes a bag: PointCloud2, Odometry, Imu, /tf, /tf_static and /clock. Every time in it is that of a record, so the
/// same records give the same bytes. It appears complete on finish() or not at all.
class BagWriter {
 public:
  /// compression: of MCAP, "", "zstd" or "lz4". Throws EnvironmentError when the file cannot be written, as the other
  /// functions do.
  BagWriter(const std::string& path, const BagProfile& profile, const Calibration& calibration,
            BagFormat format = BagFormat::ros1, std::string_view compression = {});
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// A scan and the records since the one before it, up to its stamp.
  void add(const Scan& scan, std::span<const Odometry> odometry, std::span<const Imu> imu,
           std::span<const OdometryCovariance> covariances = {});
  /// For viewers, never read here, and of ROS 2 alone: the building on /building (markers), its plan on /map (a grid of
  /// 5 cm), both latched (transient local), in the frame map, which is W. Before the first record.
  void add_building(const ros::BuildingView& view);
  /// For scoring elsewhere, never read here: X_WR on /ground_truth/odom.
  void add_truth(std::span<const StampedPose> truth_W);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Topics to read from a bag; empty: the first one of its type.
struct BagTopics {
  std::string points, odometry, imu;
  bool point_times = true;  ///< false: times that cannot be read in all of the first clouds are left out of every one
};

/// True for a file that starts as a ROS 1 bag, an MCAP or an SQLite file, and a folder of a rosbag2. Throws InputError
/// where it cannot be read.
[[nodiscard]] bool is_bag(const std::string& path);

/// Opens a bag of any of these kinds, of ROS 1 or 2. Clouds are PointCloud2 or Livox's CustomMsg; an IMU whose first
/// acceleration is within 15 % of 1 is taken to be in g, as Livox's. A record that comes
/// later than newer ones of its topic, by at most a second, or has the stamp of the one before it, is left out and
/// counted. So are one whose stamp leaps ahead of those around it, one that was recorded at no possible time, odometry
/// and IMU that are not finite or no rotation, scans before the odometry, and an IMU that /tf_static does not join to
/// the robot; the mount comes from /tf_static where `info` is null, and so does the IMU's attitude where it is there.
/// What points' times count from is told once, from the first scans. A ROS 1 bag is checked as a whole first
/// (check_bag), others as they are read. O is moved to the robot's first position and heading. Without odometry a joint
/// that moves on /tf stands for it, see with_odometry_of_transforms(), where the mount is known. Throws InputError when
/// it is no bag, holds no cloud, has a LiDAR that /tf_static does not join to the robot, odometry that overlaps no scan
/// or has one stamp, or loses more than half of its scans or odometry so.
[[nodiscard]] std::unique_ptr<Recording> open_bag(const std::string& path, const BagTopics& topics,
                                                  const RecordingInfo* info);

}  // namespace plumbline::slam
