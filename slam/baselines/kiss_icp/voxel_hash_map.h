// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "slam/scan/voxel.h"

namespace plumbline::slam::kiss {

/// Local map: some points of each voxel as they were measured, at some distance from each other.
class VoxelHashMap {
 public:
  /// Points that the map holds room for at most, 200 MB.
  static constexpr std::size_t most_points = 8'000'000;

  VoxelHashMap(double voxel_m, int max_points_per_voxel);

  /// True when the point was added: its voxel has less than max_points_per_voxel points, none of them nearer than
  /// voxel_m / sqrt(max_points_per_voxel). Never beyond the reach.
  bool add(const Eigen::Vector3d& p_M);
  /// Drops the voxels whose first point lies max_range_m or farther from the center.
  void drop_beyond(const Eigen::Vector3d& center_M, double max_range_m);
  /// The nearest point in the 27 voxels around p_M, if it is nearer than sqrt(max_distance2), else nullptr. Of equals
  /// the one in the voxel visited first: the point's own, the seven on its nearer sides, the others by (z, y, x); of
  /// these the one added first. Valid until the map changes.
  [[nodiscard]] const Eigen::Vector3d* nearest(const Eigen::Vector3d& p_M, double max_distance2) const;

  [[nodiscard]] bool empty() const { return counts_.empty(); }
  [[nodiscard]] std::size_t voxels() const { return counts_.size(); }
  /// Largest coordinate of a point that the map can hold.
  [[nodiscard]] double reach_m() const { return 1e6 * voxel_m_; }

 private:
  [[nodiscard]] bool reaches(const Eigen::Vector3d& p_M) const;
  [[nodiscard]] std::span<const Eigen::Vector3d> points_of(int slot) const;

  double voxel_m_;
  std::size_t capacity_;  ///< points a voxel
  double min_distance2_;
  VoxelIndex index_;
  std::vector<VoxelKey> keys_;           ///< by slot
  std::vector<int> counts_;              ///< by slot
  std::vector<Eigen::Vector3d> points_;  ///< capacity_ for each slot
};

}  // namespace plumbline::slam::kiss
