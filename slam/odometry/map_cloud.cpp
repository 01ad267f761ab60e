// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/map_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "slam/odometry/voxel.h"

namespace plumbline::slam {

namespace {

std::vector<Eigen::Vector3f> thin(const std::vector<Eigen::Vector3d>& points, double voxel_m) {
  std::vector<Eigen::Vector3f> thinned;
  for (const Eigen::Vector3d& p : voxel_downsample(points, voxel_m)) thinned.emplace_back(p.cast<float>());
  return thinned;
}

/// Of each voxel that holds a point, how many of the 124 within two cells of it do too. keys: packed, rising.
std::vector<int> neighbours(const std::vector<std::uint64_t>& keys) {
  constexpr std::int64_t reach = 2, row = std::int64_t{1} << 21, layer = std::int64_t{1} << 42;  // of VoxelKey::packed
  std::vector<int> count(keys.size(), -1);                                                       // itself
  for (std::int64_t z = -reach; z <= reach; ++z)
    for (std::int64_t y = -reach; y <= reach; ++y) {
      std::size_t first = 0;  // in the row beside, which keys pass in the same order
      for (std::size_t k = 0; k < keys.size(); ++k) {
        const std::int64_t middle = static_cast<std::int64_t>(keys[k]) + z * layer + y * row;
        while (first < keys.size() && static_cast<std::int64_t>(keys[first]) < middle - reach) ++first;
        for (std::size_t n = first; n < keys.size() && static_cast<std::int64_t>(keys[n]) <= middle + reach; ++n)
          ++count[k];
      }
    }
  return count;
}

/// Shortest range from which each of the voxels was seen, m, by slot.
std::vector<double> ranges_of(const VoxelIndex& voxels, std::span<const CloudKeyframe> keyframes, double voxel_m) {
  std::vector<double> range_m(static_cast<std::size_t>(voxels.size()), std::numeric_limits<double>::infinity());
  for (const CloudKeyframe& keyframe : keyframes)
    for (const Eigen::Vector3f& p_R : keyframe.points_R) {
      const int slot = voxels.find(VoxelKey::of(keyframe.X_FR * p_R.cast<double>(), voxel_m));
      if (slot < 0) continue;
      double& known = range_m[static_cast<std::size_t>(slot)];
      known = std::min(known, static_cast<double>(p_R.norm()));
    }
  return range_m;
}

/// Beams spread with range, so that less is asked of what was seen from afar only.
void drop_strays(std::vector<Eigen::Vector3f>& points, std::span<const CloudKeyframe> keyframes,
                 const MapCloudConfig& config, std::span<const Plane> levels) {
  if (config.min_neighbours == 0) return;
  const auto key_of = [&](const Eigen::Vector3f& p) { return VoxelKey::of(p.cast<double>(), config.voxel_m); };
  const auto on_level = [&](const Eigen::Vector3f& p) {
    return std::any_of(levels.begin(), levels.end(),
                       [&](const Plane& level) { return std::abs(level.distance(p.cast<double>())) < config.voxel_m; });
  };
  std::vector<std::uint64_t> keys;
  for (const Eigen::Vector3f& p : points) keys.push_back(key_of(p).packed());
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const std::vector<int> all = neighbours(keys);
  VoxelIndex sparse;
  std::vector<int> count;
  for (const Eigen::Vector3f& p : points) {
    const auto at = std::lower_bound(keys.begin(), keys.end(), key_of(p).packed()) - keys.begin();
    const int n = all[static_cast<std::size_t>(at)];
    if (n >= config.min_neighbours || on_level(p)) continue;
    const auto slot = static_cast<std::size_t>(sparse.insert(key_of(p)));
    if (slot == count.size()) count.push_back(n);  // rounding may put two points in one voxel
  }
  const std::vector<double> range_m = ranges_of(sparse, keyframes, config.voxel_m);
  std::erase_if(points, [&](const Eigen::Vector3f& p) {
    const auto slot = static_cast<std::size_t>(sparse.find(key_of(p)));
    return slot < count.size() && count[slot] * range_m[slot] < config.min_neighbours * config.dense_m;
  });
}

}  // namespace

std::vector<Eigen::Vector3f> thin_scan(const DeskewedScan& scan, const MapCloudConfig& config) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m)
      points.push_back(scan.point_R[i]);
  return thin(points, config.voxel_m);
}

std::vector<Eigen::Vector3f> map_cloud(std::span<const CloudKeyframe> keyframes, const MapCloudConfig& config,
                                       std::span<const Plane> levels) {
  std::vector<Eigen::Vector3d> points;
  for (const CloudKeyframe& keyframe : keyframes)
    for (const Eigen::Vector3f& p_R : keyframe.points_R) points.emplace_back(keyframe.X_FR * p_R.cast<double>());
  std::vector<Eigen::Vector3f> map = thin(points, config.voxel_m);
  drop_strays(map, keyframes, config, levels);
  return map;
}

bool MapCloudRecorder::add(const DeskewedScan& scan, const Pose& X_FR) {
  if (!keyframes_.empty() && (keyframes_.back().X_FR.t - X_FR.t).norm() < config_.spacing_m) return false;
  keyframes_.push_back({X_FR, thin_scan(scan, config_)});
  return true;
}

}  // namespace plumbline::slam
