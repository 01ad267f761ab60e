// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/support.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace plumbline::slam {

namespace {

/// Share of the surfels facing a direction below which odometry tells the motion there: what they face moves. Chosen on
/// crowds in a corridor and a highway (medians 0.07 to 0.17) and three walks without (5th percentiles 0.36 to 0.72).
constexpr double least_support = 0.45;

/// The same among movers, where registration contradicts odometry by so many standard deviations: it follows the crowd.
/// Chosen on five crowds, where 9 of 78 to 35 of 41 of the scans with shares of 0.45 to 0.75 contradict; on five walks
/// without movers 19 to 38 % of the scans have such shares.
constexpr double least_support_against_odometry = 0.8, contradiction_sigmas = 6.0;

}  // namespace

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
    const std::optional<SurfelMap::Voxel> voxel =
        map.find(mean_M, normal_M, surfel.faces_sensor, config.min_normal_agreement);
    if (!voxel) continue;
    if (std::abs(normal_M.dot(mean_M - voxel->sum / voxel->n)) < residuals * residual_m) met += faces;
  }
  // The least and the most of d^T met d / d^T all d.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> eigen(met, all);
  return {eigen.eigenvectors().col(0).normalized(), eigen.eigenvalues()(0) / eigen.eigenvalues()(2)};
}

std::optional<Eigen::Vector3d> moving_direction(std::span<const Surfel> surfels, const SurfelMap& map,
                                                const Registration& found, const Pose& expected, double sigma_m,
                                                const RegistrationConfig& config, bool among_movers) {
  const LeastSupported least = least_supported(surfels, map, found.X_MR, config, found.residual_m);
  const double off_m = least.direction_R.dot((found.X_MR.inverse() * expected).t);
  const bool contradicts = among_movers && std::abs(off_m) > contradiction_sigmas * sigma_m;
  if (least.share >= (contradicts ? least_support_against_odometry : least_support)) return std::nullopt;
  return least.direction_R;
}

}  // namespace plumbline::slam
