// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/map_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

std::vector<Eigen::Vector3f> to_float(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3f> rounded;
  rounded.reserve(points.size());
  for (const Eigen::Vector3d& p : points) rounded.emplace_back(p.cast<float>());
  return rounded;
}

/// All points in F by voxel.
struct Voxels {
  VoxelMeans means;
  std::vector<float> range_m;  ///< shortest from which each was seen, by slot

  Voxels(std::span<const CloudKeyframe> keyframes, double voxel_m) : means(voxel_m) {
    for (const CloudKeyframe& keyframe : keyframes)
      for (const Eigen::Vector3f& p_R : keyframe.points_R) {
        const auto slot = static_cast<std::size_t>(means.add(keyframe.X_FR * p_R.cast<double>()));
        const float range = p_R.norm();
        if (slot == range_m.size())
          range_m.push_back(range);
        else
          range_m[slot] = std::min(range_m[slot], range);
      }
  }
};

/// Of each voxel that holds a point, how many of the 124 within two cells of it do too. keys: packed, rising.
std::vector<int> neighbours(const std::vector<std::uint64_t>& keys) {
  constexpr std::int64_t reach = 2;
  std::vector<int> count(keys.size(), -1);  // itself
  for (std::int64_t z = -reach; z <= reach; ++z)
    for (std::int64_t y = -reach; y <= reach; ++y) {
      std::size_t first = 0;  // in the row beside, which keys pass in the same order
      for (std::size_t k = 0; k < keys.size(); ++k) {
        const std::int64_t middle =
            static_cast<std::int64_t>(keys[k]) + z * VoxelKey::packed_layer + y * VoxelKey::packed_row;
        while (first < keys.size() && static_cast<std::int64_t>(keys[first]) < middle - reach) ++first;
        for (std::size_t n = first; n < keys.size() && static_cast<std::int64_t>(keys[n]) <= middle + reach; ++n)
          ++count[k];
      }
    }
  return count;
}

/// Beams spread with range, so that fewer neighbours are required of what was seen from afar only.
void drop_strays(std::vector<Eigen::Vector3f>& points, const Voxels& voxels, const MapCloudConfig& config,
                 std::span<const Plane> levels) {
  if (config.min_neighbours == 0) return;
  const auto key_of = [&](const Eigen::Vector3f& p) { return VoxelKey::of(p.cast<double>(), config.voxel_m).packed(); };
  const auto on_level = [&](const Eigen::Vector3f& p) {
    return std::any_of(levels.begin(), levels.end(),
                       [&](const Plane& level) { return std::abs(level.distance(p.cast<double>())) < config.voxel_m; });
  };
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector3f& p : points) keys.push_back(key_of(p));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const std::vector<int> all = neighbours(keys);
  std::erase_if(points, [&](const Eigen::Vector3f& p) {
    const auto at = std::lower_bound(keys.begin(), keys.end(), key_of(p)) - keys.begin();
    const int count = all[static_cast<std::size_t>(at)];
    if (count >= config.min_neighbours || on_level(p)) return false;
    const int slot = voxels.means.find(p.cast<double>());
    if (slot < 0) return false;  // rounded into a voxel beside its own
    return count * static_cast<double>(voxels.range_m[static_cast<std::size_t>(slot)]) <
           config.min_neighbours * config.dense_m;
  });
}

}  // namespace

std::size_t point_count(std::span<const CloudKeyframe> keyframes) {
  std::size_t count = 0;
  for (const CloudKeyframe& keyframe : keyframes) count += keyframe.points_R.size();
  return count;
}

std::vector<Eigen::Vector3f> thin_scan(const DeskewedScan& scan, const MapCloudConfig& config) {
  VoxelMeans voxels(config.voxel_m);
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] >= config.min_range_m && scan.range_m[i] <= config.max_range_m) voxels.add(scan.point_R[i]);
  return to_float(voxels.means());
}

CloudKeyframe thin_rings(const DeskewedScan& scan, const Pose& X_FR, const MapCloudConfig& config) {
  CloudKeyframe cloud{X_FR, {}, {}};
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t ring = 0; ring < rings; ++ring) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    VoxelKey voxel;
    const auto close = [&] {
      if (count == 0) return;
      cloud.points_R.emplace_back((sum / count).cast<float>());
      cloud.lasers.push_back(static_cast<std::uint8_t>(ring));
      sum.setZero();
      count = 0;
    };
    for (std::size_t i = ring; i < scan.range_m.size(); i += rings) {
      if (scan.range_m[i] < config.min_range_m || scan.range_m[i] > config.max_range_m) continue;
      const VoxelKey here = VoxelKey::of(scan.point_R[i], config.voxel_m);
      if (!(here == voxel)) close();
      voxel = here;
      sum += scan.point_R[i];
      ++count;
    }
    close();
  }
  cloud.points_R.shrink_to_fit();  // many of them are kept
  cloud.lasers.shrink_to_fit();
  return cloud;
}

std::vector<Eigen::Vector3f> map_cloud(std::span<const CloudKeyframe> keyframes, const MapCloudConfig& config,
                                       std::span<const Plane> levels) {
  const Voxels voxels(keyframes, config.voxel_m);
  std::vector<Eigen::Vector3f> map = to_float(voxels.means.means());
  drop_strays(map, voxels, config, levels);
  return map;
}

std::vector<Eigen::Vector3f> thin_map(const std::vector<Eigen::Vector3f>& points_F, double voxel_m) {
  VoxelMeans voxels(voxel_m);
  for (const Eigen::Vector3f& p : points_F) voxels.add(p.cast<double>());
  std::vector<Eigen::Vector3f> thinned = to_float(voxels.means());
  constexpr double thinned_already = 0.99;  // rounding moves a mean into the voxel beside its own
  return static_cast<double>(thinned.size()) > thinned_already * static_cast<double>(points_F.size()) ? points_F
                                                                                                      : thinned;
}

bool MapCloudRecorder::add(const DeskewedScan& scan, const Pose& X_FR) {
  if (!keyframes_.empty() && (keyframes_.back().X_FR.t - X_FR.t).norm() < config_.spacing_m) return false;
  keep(scan, X_FR);
  return true;
}

void MapCloudRecorder::keep(const DeskewedScan& scan, const Pose& X_FR) {
  keyframes_.push_back({X_FR, thin_scan(scan, config_), {}});
}

}  // namespace plumbline::slam
