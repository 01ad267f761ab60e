// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "slam/scan/voxel.h"

namespace plumbline::slam::loam {

/// Points, the first one of each leaf voxel, with their nearest neighbours at hand. A mean would not do: near an edge
/// it lies on neither of the two surfaces.
class PointMap {
 public:
  static constexpr std::size_t neighbours = 5;
  using Neighbours = std::array<Eigen::Vector3d, neighbours>;

  /// reach_m: of the farthest neighbour that nearest() finds.
  explicit PointMap(double leaf_m, double reach_m = 1.0);

  void add(const Eigen::Vector3d& p_M);
  [[nodiscard]] bool empty() const { return points_.empty(); }
  /// The five nearest points, nearest first (ties: added earlier); false when fewer lie within sqrt(max_distance2),
  /// which may not exceed the reach.
  [[nodiscard]] bool nearest(const Eigen::Vector3d& p_M, double max_distance2, Neighbours& found) const;

 private:
  [[nodiscard]] VoxelKey cell_of(const VoxelKey& leaf) const;

  double leaf_m_;
  std::int32_t leaves_per_cell_;
  VoxelIndex leaf_index_;
  std::vector<Eigen::Vector3d> points_;
  VoxelIndex cell_index_;                ///< cells of the reach or a little more
  std::vector<std::vector<int>> cells_;  ///< points by cell
};

}  // namespace plumbline::slam::loam
