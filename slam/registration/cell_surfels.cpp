// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/cell_surfels.h"

#include <Eigen/Eigenvalues>
#include <optional>

#include "slam/scan/moments.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

/// Sums over one voxel's points, less its centre: far from the origin squares would drown differences.
struct Cell {
  VoxelKey key;
  Moments moments;
  double time_s = 0.0;  ///< sum
};

class Cells {
 public:
  Cells(std::span<const Eigen::Vector3f> points, std::span<const float> times_s, double size) : size_(size) {
    std::size_t slot = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f& point = points[i];
      if (!point.allFinite()) continue;
      const Eigen::Vector3d p = point.cast<double>();
      const VoxelKey key = VoxelKey::of(p, size);
      // Points come along scan lines: most fall into the last one's cell.
      if (cells_.empty() || !(key == cells_[slot].key)) {
        slot = static_cast<std::size_t>(index_.insert(key));
        if (slot == cells_.size()) cells_.push_back({key, {}, 0.0});
      }
      cells_[slot].moments.add(p - centre(key));
      if (!times_s.empty()) cells_[slot].time_s += static_cast<double>(times_s[i]);
    }
  }

  [[nodiscard]] const std::vector<Cell>& all() const { return cells_; }
  [[nodiscard]] Eigen::Vector3d centre(const VoxelKey& key) const {
    return size_ * (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5));
  }

  /// Of a cell and the six that share a face with it, about its centre.
  [[nodiscard]] Moments round(const Cell& cell) const {
    Moments sum = cell.moments;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const Eigen::Vector3i step = side * Eigen::Vector3i::Unit(axis);
        const int slot = index_.find({cell.key.x + step.x(), cell.key.y + step.y(), cell.key.z + step.z()});
        if (slot < 0) continue;
        const Moments& m = cells_[static_cast<std::size_t>(slot)].moments;
        const Eigen::Vector3d by = size_ * step.cast<double>();
        const Eigen::Matrix3d mixed = m.sum * by.transpose();
        sum.outer += m.outer + mixed + mixed.transpose() + m.n * by * by.transpose();
        sum.sum += m.sum + m.n * by;
        sum.n += m.n;
      }
    return sum;
  }

 private:
  double size_;
  VoxelIndex index_;
  std::vector<Cell> cells_;
};

std::optional<Eigen::Vector3d> normal_of(const Moments& moments, double thickest) {
  const Eigen::Vector3d mean = moments.mean();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(Eigen::Matrix3d(moments.outer / moments.n - mean * mean.transpose()));
  const Eigen::Vector3d& l = eigen.eigenvalues();
  // A line of points has no normal: the second direction must stand out of the first.
  if (l(0) > thickest * thickest || l(1) < 2.0 * l(0)) return std::nullopt;
  return eigen.eigenvectors().col(0);
}

}  // namespace

std::vector<Surfel> cell_surfels(std::span<const Eigen::Vector3f> points, const CellSurfels& config,
                                 std::span<const float> times_s) {
  const Cells cells(points, times_s, config.size_m);
  std::vector<Surfel> surfels;
  for (const Cell& cell : cells.all()) {
    const Moments round = cells.round(cell);
    if (round.n < config.min_points) continue;
    if (const std::optional<Eigen::Vector3d> normal = normal_of(round, config.max_thickness_m))
      surfels.push_back(
          {cells.centre(cell.key) + cell.moments.mean(), *normal, static_cast<float>(cell.time_s / cell.moments.n)});
  }
  return surfels;
}

}  // namespace plumbline::slam
