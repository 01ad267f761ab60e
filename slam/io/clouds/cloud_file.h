// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "slam/io/clouds/cloud_header.h"
#include "slam/io/packets/point_cloud.h"

namespace plumbline::slam {

/// Reads a .pcd (ASCII, binary or compressed) or .ply file by PCL; stamp 0. Fields of more than one number are left
/// out. Throws InputError on what read_cloud_header() refuses and on a body that is damaged.
[[nodiscard]] PointCloud read_cloud_file(const std::string& file);

/// Writes a binary .pcd or .ply file by PCL: the same cloud gives the same bytes. Throws EnvironmentError when it
/// cannot be written. A .ply holds the fields f32, f64, u8, i32 and u32 alone, since PCL writes no others.
void write_cloud_file(const std::string& file, const PointCloud& cloud);

/// A cloud of float x, y, z without times. Throws InternalError at a point that is not finite.
[[nodiscard]] PointCloud cloud_of(const std::vector<Eigen::Vector3f>& points);
/// The finite points of a cloud. Throws InputError at the mark where x, y and z are neither f32 nor f64.
[[nodiscard]] std::vector<Eigen::Vector3f> points_of(const PointCloud& cloud, const Mark& mark);
/// The finite points of a .pcd or .ply file.
[[nodiscard]] std::vector<Eigen::Vector3f> read_cloud_points(const std::string& file);

}  // namespace plumbline::slam
