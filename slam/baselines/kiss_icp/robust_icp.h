// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "bim/geometry/pose.h"
#include "slam/baselines/kiss_icp/voxel_hash_map.h"

namespace plumbline::slam::kiss {

struct RobustIcpOptions {
  double max_distance_m = 6.0;  ///< of a point and its map point
  double kernel_m = 2.0;        ///< of geman_mcclure()
  int max_iterations = 100;
  double convergence = 1e-4;  ///< length of a step, m and rad together, below which the iteration stops
};

struct RobustIcpResult {
  Pose X_ML;
  int iterations = 0;
  std::size_t matched = 0;   ///< points with a map point, at the last iteration
  double matched_rms = 0.0;  ///< of their distances before its step, m
};

/// Weight of a residual: s^2 / (s + r^2)^2. Metres are added to square metres, as in the reference's program.
[[nodiscard]] constexpr double geman_mcclure(double residual2_m2, double scale_m) {
  const double sum = scale_m + residual2_m2;
  return scale_m * scale_m / (sum * sum);
}

/// Point-to-point ICP: moves `guess` so that points lie on their nearest map points [vizzo2023]. Sums
/// run in the points' order. The guess where the map is empty or nothing matches; a step that is no motion ends it.
[[nodiscard]] RobustIcpResult register_points(std::span<const Eigen::Vector3d> points_L, const VoxelHashMap& map,
                                              const Pose& guess, const RobustIcpOptions& options);

}  // namespace plumbline::slam::kiss
