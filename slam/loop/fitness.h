// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Weights of relative poses as in the papers' code [lsg2022]. Variances between a least and a greatest one by the mean
/// squared distance between the two clouds.
struct FitnessConfig {
  double voxel_m = 0.1;
  double slope = 20.0;
  double limit_m2 = 0.5;
  double sigma_min_m = 0.1, sigma_max_m = 5.0;
  double sigma_min_rad = 0.1, sigma_max_rad = 0.4;

  template <class V>
  void visit(V& v) {
    v("voxel_m", voxel_m, Field{.doc = "voxel size at which the clouds are thinned", .min = 0.02});
    v("slope", slope,
      Field{
          .doc = "slope of the weight over the mean squared distance between the clouds", .unit = "1/m²", .min = 1e-3});
    v("limit_m2", limit_m2,
      Field{.doc = "mean squared distance that gets the greatest standard deviation", .min = 1e-6});
    v("sigma_min_m", sigma_min_m, Field{.doc = "least standard deviation of the translation", .min = 1e-4});
    v("sigma_max_m", sigma_max_m, Field{.doc = "greatest standard deviation of the translation", .min = 1e-4});
    v("sigma_min_rad", sigma_min_rad, Field{.doc = "least standard deviation of the rotation", .min = 1e-5});
    v("sigma_max_rad", sigma_max_rad, Field{.doc = "greatest standard deviation of the rotation", .min = 1e-5});
  }
};

/// The scan's returns in R, thinned.
[[nodiscard]] std::vector<Eigen::Vector3d> fitness_cloud(const DeskewedScan& scan, const FitnessConfig& config);

/// Mean squared distance, m^2, of b's points to their nearest of a's; neither may be empty. X_AB: pose of b in a.
[[nodiscard]] double fitness(const std::vector<Eigen::Vector3d>& points_A, const std::vector<Eigen::Vector3d>& points_B,
                             const Pose& X_AB);

/// Information of (translation, rotation) that a fitness is worth.
[[nodiscard]] Matrix6d fitness_information(double fitness_m2, const FitnessConfig& config);

}  // namespace plumbline::slam
