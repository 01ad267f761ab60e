// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/map_cloud.h"

#include <cstddef>

#include "slam/odometry/voxel.h"

namespace plumbline::slam {

namespace {

std::vector<Eigen::Vector3f> thin(const std::vector<Eigen::Vector3d>& points, double voxel_m) {
  std::vector<Eigen::Vector3f> thinned;
  for (const Eigen::Vector3d& p : voxel_downsample(points, voxel_m)) thinned.emplace_back(p.cast<float>());
  return thinned;
}

}  // namespace

std::vector<Eigen::Vector3f> thin_scan(const DeskewedScan& scan, const MapCloudConfig& config) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m)
      points.push_back(scan.point_R[i]);
  return thin(points, config.voxel_m);
}

std::vector<Eigen::Vector3f> map_cloud(std::span<const CloudKeyframe> keyframes, const MapCloudConfig& config) {
  std::vector<Eigen::Vector3d> points;
  for (const CloudKeyframe& keyframe : keyframes)
    for (const Eigen::Vector3f& p_R : keyframe.points_R) points.emplace_back(keyframe.X_FR * p_R.cast<double>());
  return thin(points, config.voxel_m);
}

bool MapCloudRecorder::add(const DeskewedScan& scan, const Pose& X_FR) {
  if (!keyframes_.empty() && (keyframes_.back().X_FR.t - X_FR.t).norm() < config_.spacing_m) return false;
  keyframes_.push_back({X_FR, thin_scan(scan, config_)});
  return true;
}

}  // namespace plumbline::slam
