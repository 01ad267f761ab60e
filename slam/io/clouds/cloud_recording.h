// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/recordings/motion_files.h"
#include "slam/io/recordings/recording.h"

namespace plumbline::slam {

/// True for a folder that holds point clouds of one ending, .pcd, .ply or .bin, and besides them at most
/// recording.yaml, their times, odometry.tum and imu.csv; also for one of KITTI's that has such a folder in it:
/// velodyne, velodyne_points/data or data.
[[nodiscard]] bool is_cloud_folder(const std::string& path);

/// What keeps a folder that holds clouds from being one, "point clouds of more than one ending; ..."; empty where
/// it is one, and where clouds are not most of what it holds.
[[nodiscard]] std::string why_no_cloud_folder(const std::string& path);

/// Opens such a folder: a cloud is a scan, in the order of the numbers in their names (7.pcd, 10.pcd, ...), with the
/// times of find_cloud_times(), else one each lidar.period_s. A cloud whose time is no later than that of one before it
/// is left out and counted. Points have times and rings where the files name them, see scan_of(PointCloud). Odometry
/// and IMU are `given`, else odometry.tum and imu.csv beside them. `info`, where it is not null, stands for
/// recording.yaml. Throws InputError.
[[nodiscard]] std::unique_ptr<Recording> open_cloud_folder(const std::string& path, const RecordingInfo* info = nullptr,
                                                           const MotionFiles& given = {});

}  // namespace plumbline::slam
