// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/fitness.h"

#include <cmath>

#include "slam/scan/kd_tree.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

std::vector<Eigen::Vector3d> fitness_cloud(const DeskewedScan& scan, const FitnessConfig& config) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] > 0.0) points.push_back(scan.point_R[i]);
  return voxel_downsample(points, config.voxel_m);
}

double fitness(const std::vector<Eigen::Vector3d>& points_A, const std::vector<Eigen::Vector3d>& points_B,
               const Pose& X_AB) {
  const KdTree tree(points_A);
  double sum = 0.0;
  for (const Eigen::Vector3d& p_B : points_B) sum += tree.nearest(X_AB * p_B, 1).front().distance2;
  return sum / static_cast<double>(points_B.size());
}

Matrix6d fitness_information(double fitness_m2, const FitnessConfig& config) {
  const double share = std::expm1(-config.slope * fitness_m2) / std::expm1(-config.slope * config.limit_m2);
  const auto variance = [&](double least, double most) {
    return least * least + (most * most - least * least) * std::min(1.0, share);
  };
  Vector6d information;
  information << Eigen::Vector3d::Constant(1.0 / variance(config.sigma_min_m, config.sigma_max_m)),
      Eigen::Vector3d::Constant(1.0 / variance(config.sigma_min_rad, config.sigma_max_rad));
  return information.asDiagonal();
}

}  // namespace plumbline::slam
