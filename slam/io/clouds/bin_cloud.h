// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// Whether the file's ending is .bin.
[[nodiscard]] bool is_bin_cloud(std::string_view file);

/// Reads bare points without a header, float32 each: x, y, z, intensity, as KITTI has them [geiger2012], and of a file
/// .pcd.bin ring behind them, as nuScenes; stamp 0. Throws InputError with the file's name where it is empty, holds no
/// whole number of points, more than 4 million, or mostly numbers that no LiDAR measures.
[[nodiscard]] PointCloud read_bin_cloud(const std::string& file);

}  // namespace plumbline::slam
