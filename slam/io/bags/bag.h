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

/// Names and forms that a family of programs expects in a ROS 1 bag.
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

/// Writes a ROS 1 bag (LZ4): PointCloud2, Odometry, Imu, /tf, /tf_static and /clock. Every time in it is that of a
/// record, so the same records give the same bytes. The file appears complete on finish() or not at all.
class BagWriter {
 public:
  /// Throws EnvironmentError when the file cannot be written, as the other functions do.
  BagWriter(const std::string& path, const BagProfile& profile, const Calibration& calibration);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// A scan and the records since the one before it, up to its stamp.
  void add(const Scan& scan, std::span<const Odometry> odometry, std::span<const Imu> imu,
           std::span<const OdometryCovariance> covariances = {});
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
};

/// True when the file starts as a ROS 1 bag. Throws InputError where it cannot be read.
[[nodiscard]] bool is_bag(const std::string& path);

/// Opens a bag. Records are put in order by their own stamps; the mount comes from /tf_static where `info` is null, and
/// so does the IMU's attitude where it is there. The bag is checked as a whole first (check_bag). O is moved to the
/// robot's first position and heading. Throws InputError when it is no bag, was not closed, holds no cloud, has an IMU
/// of unknown attitude or odometry that overlaps no scan.
[[nodiscard]] std::unique_ptr<Recording> open_bag(const std::string& path, const BagTopics& topics,
                                                  const RecordingInfo* info);

}  // namespace plumbline::slam
