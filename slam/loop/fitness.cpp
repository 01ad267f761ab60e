// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/fitness.h"

#include <cmath>
#include <nanoflann.hpp>

#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

/// Adaptor of a cloud to nanoflann.
struct Cloud {
  const std::vector<Eigen::Vector3d>& points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree3 = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::size_t>;

}  // namespace

std::vector<Eigen::Vector3d> fitness_cloud(const DeskewedScan& scan, const FitnessConfig& config) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] > 0.0) points.push_back(scan.point_R[i]);
  return voxel_downsample(points, config.voxel_m);
}

double fitness(const std::vector<Eigen::Vector3d>& points_A, const std::vector<Eigen::Vector3d>& points_B,
               const Pose& X_AB) {
  const Cloud cloud{points_A};
  const Tree3 tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  double sum = 0.0;
  for (const Eigen::Vector3d& p_B : points_B) {
    const Eigen::Vector3d p_A = X_AB * p_B;
    std::size_t nearest = 0;
    double squared = 0.0;
    tree.knnSearch(p_A.data(), 1, &nearest, &squared);
    sum += squared;
  }
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
