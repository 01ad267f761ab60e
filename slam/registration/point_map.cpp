// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/point_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline::slam::loam {

namespace {

/// The best five, kept in order.
class Best {
 public:
  explicit Best(double max_distance2) {
    distance2_.fill(max_distance2);
    id_.fill(-1);
  }
  [[nodiscard]] double worst() const { return distance2_.back(); }
  [[nodiscard]] bool full() const { return id_.back() >= 0; }
  [[nodiscard]] int id(std::size_t k) const { return id_[k]; }

  void offer(double distance2, int id) {
    const auto before = [&](std::size_t k) {
      return distance2 < distance2_[k] || (distance2 == distance2_[k] && (id_[k] < 0 || id < id_[k]));
    };
    if (!before(last)) return;
    std::size_t k = last;
    for (; k > 0 && before(k - 1); --k) {
      distance2_[k] = distance2_[k - 1];
      id_[k] = id_[k - 1];
    }
    distance2_[k] = distance2;
    id_[k] = id;
  }

 private:
  static constexpr std::size_t last = PointMap::neighbours - 1;
  std::array<double, PointMap::neighbours> distance2_{};
  std::array<int, PointMap::neighbours> id_{};
};

/// Squared distance from a point to a cell's box; size in m.
double distance2_to(const VoxelKey& key, const Eigen::Vector3d& p, double size) {
  const Eigen::Vector3d low = size * Eigen::Vector3d(key.x, key.y, key.z);
  const Eigen::Vector3d high = low + Eigen::Vector3d::Constant(size);
  return (p - p.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

std::int32_t floor_divide(std::int32_t a, std::int32_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

PointMap::PointMap(double leaf_m, double reach_m)
    : leaf_m_(leaf_m), leaves_per_cell_(static_cast<std::int32_t>(std::ceil(reach_m / leaf_m))) {}

/// A cell holds whole leaves.
VoxelKey PointMap::cell_of(const VoxelKey& leaf) const {
  return {floor_divide(leaf.x, leaves_per_cell_), floor_divide(leaf.y, leaves_per_cell_),
          floor_divide(leaf.z, leaves_per_cell_)};
}

void PointMap::add(const Eigen::Vector3d& p_M) {
  const VoxelKey key = VoxelKey::of(p_M, leaf_m_);
  const auto slot = static_cast<std::size_t>(leaf_index_.insert(key));
  if (slot < points_.size()) return;
  points_.push_back(p_M);
  const auto cell = static_cast<std::size_t>(cell_index_.insert(cell_of(key)));
  if (cell == cells_.size()) cells_.emplace_back();
  cells_[cell].push_back(static_cast<int>(slot));
}

bool PointMap::nearest(const Eigen::Vector3d& p_M, double max_distance2, Neighbours& found) const {
  Best best(max_distance2);
  const VoxelKey home = cell_of(VoxelKey::of(p_M, leaf_m_));
  const double cell_m = leaves_per_cell_ * leaf_m_;
  const auto visit = [&](const VoxelKey& key) {
    const int cell = cell_index_.find(key);
    if (cell < 0) return;
    for (const int id : cells_[static_cast<std::size_t>(cell)])
      best.offer((points_[static_cast<std::size_t>(id)] - p_M).squaredNorm(), id);
  };
  visit(home);
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const VoxelKey key{home.x + dx, home.y + dy, home.z + dz};
        if (key == home) continue;
        if (distance2_to(key, p_M, cell_m) <= best.worst()) visit(key);
      }
  if (!best.full()) return false;
  for (std::size_t k = 0; k < neighbours; ++k) found[k] = points_[static_cast<std::size_t>(best.id(k))];
  return true;
}

}  // namespace plumbline::slam::loam
