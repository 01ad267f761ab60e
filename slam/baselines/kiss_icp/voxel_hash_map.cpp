// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/voxel_hash_map.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam::kiss {

namespace {

/// Along one axis: the side on which the voxel beside is nearer to x, and the squared distances to the voxels on that
/// side and on the other. The cell is x's own.
struct Sides {
  std::int32_t near = 1;
  double near2 = 0.0, far2 = 0.0;

  Sides(double x, std::int32_t cell, double voxel_m) {
    const double below = x - voxel_m * cell, above = voxel_m - below;
    near = below < above ? -1 : 1;
    near2 = below < above ? below * below : above * above;
    far2 = below < above ? above * above : below * below;
  }
  [[nodiscard]] double gap2(std::int32_t step) const { return step == 0 ? 0.0 : step == near ? near2 : far2; }
};

}  // namespace

VoxelHashMap::VoxelHashMap(double voxel_m, int max_points_per_voxel)
    : voxel_m_(voxel_m),
      capacity_(static_cast<std::size_t>(max_points_per_voxel)),
      min_distance2_(voxel_m * voxel_m / max_points_per_voxel) {}

bool VoxelHashMap::reaches(const Eigen::Vector3d& p_M) const {  // not-a-number compares false
  return std::abs(p_M.x()) < reach_m() && std::abs(p_M.y()) < reach_m() && std::abs(p_M.z()) < reach_m();
}

std::span<const Eigen::Vector3d> VoxelHashMap::points_of(int slot) const {
  const auto k = static_cast<std::size_t>(slot);
  return {points_.data() + k * capacity_, static_cast<std::size_t>(counts_[k])};
}

bool VoxelHashMap::add(const Eigen::Vector3d& p_M) {
  if (!reaches(p_M)) return false;
  const VoxelKey key = VoxelKey::of(p_M, voxel_m_);
  int slot = index_.find(key);
  if (slot < 0) {
    if ((counts_.size() + 1) * capacity_ > most_points) return false;
    slot = index_.insert(key);
    keys_.push_back(key);
    counts_.push_back(0);
    points_.resize(points_.size() + capacity_);
  }
  const std::span<const Eigen::Vector3d> there = points_of(slot);
  if (there.size() == capacity_) return false;
  for (const Eigen::Vector3d& q_M : there)
    if ((q_M - p_M).squaredNorm() < min_distance2_) return false;
  const auto k = static_cast<std::size_t>(slot);
  points_[k * capacity_ + there.size()] = p_M;
  ++counts_[k];
  return true;
}

void VoxelHashMap::drop_beyond(const Eigen::Vector3d& center_M, double max_range_m) {
  const double max_range2 = max_range_m * max_range_m;
  const std::size_t before = counts_.size();
  for (std::size_t k = 0; k < counts_.size();) {
    if ((points_[k * capacity_] - center_M).squaredNorm() < max_range2) {
      ++k;
      continue;
    }
    // The last voxel takes its slot.
    const std::size_t last = counts_.size() - 1;
    keys_[k] = keys_[last];
    counts_[k] = counts_[last];
    if (k != last) std::copy_n(&points_[last * capacity_], counts_[last], &points_[k * capacity_]);
    keys_.pop_back();
    counts_.pop_back();
    points_.resize(last * capacity_);
  }
  if (counts_.size() == before) return;
  index_.clear();
  for (const VoxelKey& key : keys_) static_cast<void>(index_.insert(key));
}

const Eigen::Vector3d* VoxelHashMap::nearest(const Eigen::Vector3d& p_M, double max_distance2) const {
  if (!reaches(p_M)) return nullptr;
  const Eigen::Vector3d* found = nullptr;
  double best = max_distance2;
  const auto visit = [&](const VoxelKey& key) {
    const int slot = index_.find(key);
    if (slot < 0) return;
    for (const Eigen::Vector3d& q_M : points_of(slot)) {
      const double distance2 = (q_M - p_M).squaredNorm();
      if (!(distance2 < best)) continue;
      best = distance2;
      found = &q_M;
    }
  };
  const VoxelKey home = VoxelKey::of(p_M, voxel_m_);
  visit(home);
  const Sides x(p_M.x(), home.x, voxel_m_), y(p_M.y(), home.y, voxel_m_), z(p_M.z(), home.z, voxel_m_);
  for (unsigned side = 1; side < 8; ++side) {
    const bool along_x = (side & 1U) != 0, along_y = (side & 2U) != 0, along_z = (side & 4U) != 0;
    if ((along_x ? x.near2 : 0.0) + (along_y ? y.near2 : 0.0) + (along_z ? z.near2 : 0.0) >= best) continue;
    visit({home.x + (along_x ? x.near : 0), home.y + (along_y ? y.near : 0), home.z + (along_z ? z.near : 0)});
  }
  if (std::min({x.far2, y.far2, z.far2}) >= best) return found;
  for (std::int32_t dz = -1; dz <= 1; ++dz)
    for (std::int32_t dy = -1; dy <= 1; ++dy)
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        const bool on_far_side = dx == -x.near || dy == -y.near || dz == -z.near;
        if (!on_far_side || x.gap2(dx) + y.gap2(dy) + z.gap2(dz) >= best) continue;
        visit({home.x + dx, home.y + dy, home.z + dz});
      }
  return found;
}

}  // namespace plumbline::slam::kiss
