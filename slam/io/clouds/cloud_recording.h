// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "slam/io/recordings/recording.h"

namespace plumbline::slam {

/// True for a folder that holds point clouds of one ending, .pcd or .ply, and besides them at most recording.yaml.
[[nodiscard]] bool is_cloud_folder(const std::string& path);

/// What keeps a folder that holds clouds from being one, "point clouds of more than one ending; ..."; empty where
/// it is one, and where clouds or files .bin are not most of what it holds.
[[nodiscard]] std::string why_no_cloud_folder(const std::string& path);

/// Opens such a folder: a cloud is a scan, in the order of the numbers in their names (7.pcd, 10.pcd, ...), one each
/// lidar.period_s. Points have times and rings where the files name them, see scan_of(PointCloud). There is no
/// odometry. `info`, where it is not null, stands for recording.yaml. Throws InputError.
[[nodiscard]] std::unique_ptr<Recording> open_cloud_folder(const std::string& path,
                                                           const RecordingInfo* info = nullptr);

}  // namespace plumbline::slam
