// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/registration/surfels.h"

namespace plumbline::slam {

struct RegistrationConfig {
  double in_plane_m = 0.5;  ///< standard deviation of a surfel along its surface (PLANE regularisation)
  double across_m = 0.02;   ///< and across: range noise [facts: lidar 2.2]
  double agreement = 0.5;   ///< least mean (n . n_i)^2 of a surfel's normal with those of its voxel
  double kernel = 2.0;      ///< Cauchy, in standard deviations
  int max_iterations = 15;
  double translation_epsilon_m = 2e-4;
  double rotation_epsilon_rad = 2e-5;

  template <class V>
  void visit(V& v) {
    v("in_plane_m", in_plane_m, Field{.min = 1e-3});
    v("across_m", across_m, Field{.min = 1e-4});
    v("agreement", agreement, Field{.min = 0.0, .max = 1.0});
    v("kernel", kernel, Field{.min = 0.1});
    v("max_iterations", max_iterations, Field{.min = 1});
    v("translation_epsilon_m", translation_epsilon_m, Field{.min = 0.0});
    v("rotation_epsilon_rad", rotation_epsilon_rad, Field{.min = 0.0});
  }
};

/// Belief about which way is up: R_MR up_R = up_M within sigma_rad, with a Cauchy kernel. Says nothing about heading.
struct TiltPrior {
  Eigen::Vector3d up_R = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_M = Eigen::Vector3d::UnitZ();
  double sigma_rad = 0.01;
};

/// Belief about the pose before registration: X_MR and the information of its right increment (rho, phi).
struct PosePrior {
  Pose X_MR;
  Matrix6d information = Matrix6d::Zero();
  std::optional<TiltPrior> tilt;
};

struct Registration {
  Pose X_MR;
  Matrix6d information = Matrix6d::Zero();  ///< Gauss-Newton Hessian of the surfels alone, of the right increment
                                            ///< (rho in m, phi in rad); counts every surfel as independent
  double matched = 0.0;                     ///< share of the surfels that met a voxel and are not outliers, 0 to 1
  double rms = 0.0;                         ///< of the inliers' Mahalanobis distances; 0.3 to 0.8 for a good match
  int iterations = 0;
  bool converged = false;
  bool believed = true;  ///< false: X_MR is dead reckoning, the scan did not fit
  bool lost = false;     ///< scans have not fitted for a while
  bool followed = true;  ///< false: odometry does not know how the robot came here from the scan before
};

/// Normal equations of a registration: cost, gradient and Gauss-Newton Hessian by an increment (rho, phi).
struct Normal6 {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0.0;
  double inliers = 0.0;
  double squared = 0.0;  ///< sum over the inliers of the squared Mahalanobis distance
};

/// What else a pose is held by: normal equations of the right increment at X_MR, in units of standard deviations.
using MoreTerms = std::function<Normal6(const Pose& X_MR)>;

/// Voxelized GICP: minimises sum rho(e^T (C_voxel + R C_surfel R^T)^-1 e) with e the way from the moved surfel to the
/// mean of the voxel it falls in, plus the prior and `more` if any, by Gauss-Newton on SE(3) from `start`.
[[nodiscard]] Registration align(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& start,
                                 const std::optional<PosePrior>& prior, const RegistrationConfig& config,
                                 const MoreTerms& more = {});

/// Adds a point at arm_M from the robot, displaced by e: weighted information W and W e, axes of M.
void add_point(Normal6& sum, const Eigen::Vector3d& arm_M, const Eigen::Matrix3d& weight,
               const Eigen::Vector3d& weighted);
/// Adds what the prior says at X_MR, by the right increment.
void add_prior(Normal6& normal, const PosePrior& prior, const Pose& X_MR);
/// From increments in axes M about the robot to the right increment.
void to_right_increment(Normal6& sum, const Eigen::Matrix3d& R_MR);
/// Gauss-Newton step, nothing when the problem is singular.
[[nodiscard]] std::optional<Vector6d> solve_step(const Normal6& normal);
/// Normal equations of align() at X_MR by the right increment, robust weights included.
[[nodiscard]] Normal6 linearize(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                                const RegistrationConfig& config);

}  // namespace plumbline::slam
