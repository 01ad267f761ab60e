// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/support.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace plumbline::slam {

LeastSupported least_supported(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                               const RegistrationConfig& config, double residual_m) {
  constexpr double residuals = 3.0;
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  const double few = config.least_eigenvalue * static_cast<double>(surfels.size());
  if (!(few > 0.0)) return {};
  Eigen::Matrix3d all = few * Eigen::Matrix3d::Identity(), met = all;
  for (const Surfel& surfel : surfels) {
    const Eigen::Matrix3d faces = surfel.normal_R * surfel.normal_R.transpose();
    all += faces;
    const Eigen::Vector3d normal_M = R_MR * surfel.normal_R, mean_M = X_MR * surfel.mean_R;
    const SurfelMap::Voxel* voxel = map.find(mean_M, normal_M, config.min_normal_agreement);
    if (voxel == nullptr) continue;
    if (std::abs(normal_M.dot(mean_M - voxel->sum / voxel->n)) < residuals * residual_m) met += faces;
  }
  // The least and the most of d^T met d / d^T all d.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> eigen(met, all);
  return {eigen.eigenvectors().col(0).normalized(), eigen.eigenvalues()(0) / eigen.eigenvalues()(2)};
}

}  // namespace plumbline::slam
