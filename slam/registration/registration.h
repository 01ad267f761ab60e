// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/io/records.h"
#include "slam/registration/surfels.h"

namespace plumbline::slam {

struct RegistrationConfig {
  double sigma_tangent_m = 0.5;
  double sigma_normal_m = 0.02;
  double min_normal_agreement = 0.5;
  double cauchy_scale = 2.0;
  int max_iterations = 15;
  double translation_epsilon_m = 2e-4;
  double rotation_epsilon_rad = 2e-5;
  double least_eigenvalue = 0.003;

  template <class V>
  void visit(V& v) {
    v("sigma_tangent_m", sigma_tangent_m,
      Field{.doc = "standard deviation of a surfel along its surface (plane regularisation)",
            .min = 1e-3,
            .former = "in_plane_m"});
    // docs/methods/lidar_model.md
    v("sigma_normal_m", sigma_normal_m,
      Field{
          .doc = "standard deviation of a surfel across its surface: range noise", .min = 1e-4, .former = "across_m"});
    v("min_normal_agreement", min_normal_agreement,
      share_field("least mean (n · n_i)² of a surfel's normal with those of its voxel", {.former = "agreement"}));
    v("cauchy_scale", cauchy_scale,
      plain_field("scale of the Cauchy kernel, in standard deviations", {.min = 0.1, .former = "kernel"}));
    v("max_iterations", max_iterations, Field{.doc = "most iterations of a registration", .min = 1});
    v("translation_epsilon_m", translation_epsilon_m,
      Field{.doc = "translation of a step below which the iteration stops", .min = 0.0});
    v("rotation_epsilon_rad", rotation_epsilon_rad,
      Field{.doc = "rotation of a step below which the iteration stops", .min = 0.0});
    v("least_eigenvalue", least_eigenvalue,
      share_field("eigenvalue of the normals' Hessian per surfel below which a direction is degenerate"));
  }
};

/// Prior of the vertical: R_MR up_R = up_M within sigma_rad, with a Cauchy kernel. It does not constrain the heading.
struct TiltPrior {
  Eigen::Vector3d up_R = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_M = Eigen::Vector3d::UnitZ();
  double sigma_rad = 0.01;
};

/// Prior of the pose before registration: X_MR and the information of its right increment (rho, phi).
struct PosePrior {
  Pose X_MR;
  Matrix6d information = Matrix6d::Zero();
  std::optional<TiltPrior> tilt;
};

/// From a keyframe K, of this stamp, to where a scan was placed by correlation with it.
struct CorrelatedStep {
  Nanoseconds keyframe_stamp = 0;
  Pose X_KR;
  std::vector<Vector6d> movements;  ///< increments that it tells
};

struct Registration {
  Pose X_MR;
  /// Gauss-Newton Hessian of surfels, edges and rough points, without priors, of the right increment (rho in m, phi in
  /// rad); counts every one as independent.
  Matrix6d information = Matrix6d::Zero();
  Matrix6d open = Matrix6d::Zero();  ///< information of 1 / m^2 in the degenerate directions alone
  double matched = 0.0;              ///< share of the surfels that fall into a voxel and are not outliers, 0 to 1
  double rms = 0.0;                  ///< of the inliers' Mahalanobis distances; 0.3 to 0.8 for a good match
  double residual_m = 0.0;           ///< 1.4826 times the median distance of inliers from the surfaces they meet
  double least_eigenvalue = 1.0;  ///< of the normals' Hessian per surfel, rotations times the surfels' median distance
  int degenerate_directions = 0;  ///< that surfaces leave open: edges, odometry or the start decided there
  int unobserved_directions = 0;  ///< of those, the ones in which neither edges nor odometry tell anything ...
  std::vector<Vector6d> unobserved;          ///< ... as unit increments of X_MR, before a correlation
  bool by_rough_points = false;              ///< rough points told of those what they can
  std::optional<Eigen::Vector3d> moving_R;   ///< a degenerate translation: what faces it moves, see moving_direction()
  std::optional<CorrelatedStep> correlated;  ///< where they were told by an earlier keyframe
  Vector6d sweep_twist = Vector6d::Zero();   ///< by which the scan's deskewing was corrected, see sweep_twist()
  int iterations = 0;
  bool converged = false;
  bool from_expected = false;  ///< the expected pose leads here, too: no other start was needed
  int deskewed_again = 0;      ///< times that the scan was deskewed by the step found, until it matched best
  bool accepted = true;        ///< false: X_MR is dead reckoning, the scan did not fit
  bool began = false;          ///< the scan began a map: it was placed by what was expected of it
  bool lost = false;           ///< scans have not fitted for a while, or did not tell the way gone
  bool displaced = false;      ///< scans may fit, but the way from the first pose to these is not known
  bool odometry_valid = true;  ///< false: odometry has no valid motion from the scan before
};

/// Normal equations of a registration: cost, gradient and Gauss-Newton Hessian by an increment (rho, phi).
struct Normal6 {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0.0;
  double inliers = 0.0;
  double squared = 0.0;        ///< sum over the inliers of the squared Mahalanobis distance
  std::vector<double> across;  ///< distance of each inlier from the surface it meets, m
};

/// Additional factors of a pose: normal equations of the right increment at X_MR, in units of standard deviations.
using AdditionalFactors = std::function<Normal6(const Pose& X_MR)>;

/// What surfaces tell of a pose [zhang2016]: point-to-plane Hessian per surfel by the right increment, its rotations
/// multiplied by the surfels' median distance, so that all of it is in the same unit.
struct Observability {
  double least_eigenvalue = 1.0;
  std::vector<Vector6d> degenerate_directions;  ///< unit increments
  Matrix6d kept = Matrix6d::Identity();         ///< takes from an increment what it has of degenerate directions
  Matrix6d degenerate = Matrix6d::Zero();       ///< information of 1 / m^2 in those alone
};
[[nodiscard]] Observability observability(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                                          const RegistrationConfig& config);

/// Voxelized GICP: minimises sum rho(e^T (C_voxel + R C_surfel R^T)^-1 e) with e the vector from the moved surfel to
/// the mean of the voxel it falls in, plus the prior and `additional` if any, by Gauss-Newton on SE(3) from `start`. In
/// directions that are degenerate at the start surfels count for nothing: what they pull along their own surfaces would
/// hold the robot where it was. There the pose is kept to `expected`, else the start, within degenerate_sigma_m
/// (rotations: at the surfels' median distance), unless prior or `additional` know better, or `where_degenerate`, whose
/// factors count in these directions alone. They leave them unobserved: whoever gives them is not sure of them. The
/// translation `moving_R` (unit vector) counts as degenerate, and `additional` tells nothing of it either.
[[nodiscard]] Registration align(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& start,
                                 const std::optional<PosePrior>& prior, const RegistrationConfig& config,
                                 const AdditionalFactors& additional = {}, double degenerate_sigma_m = 0.1,
                                 const std::optional<Pose>& expected = std::nullopt,
                                 const AdditionalFactors& where_degenerate = {},
                                 const std::optional<Eigen::Vector3d>& moving_R = std::nullopt);

/// Adds a point at arm_M from the robot, displaced by e: weighted information W and W e, axes of M.
void add_point(Normal6& sum, const Eigen::Vector3d& arm_M, const Eigen::Matrix3d& weight,
               const Eigen::Vector3d& weighted);
/// Adds the prior at X_MR, by the right increment.
void add_prior(Normal6& normal, const PosePrior& prior, const Pose& X_MR);
/// From increments in axes M about the robot to the right increment.
void to_right_increment(Normal6& sum, const Eigen::Matrix3d& R_MR);
/// Gauss-Newton step, nothing when the problem is singular.
[[nodiscard]] std::optional<Vector6d> solve_step(const Normal6& normal);
/// Normal equations of align() at X_MR by the right increment, robust weights included.
[[nodiscard]] Normal6 linearize(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                                const RegistrationConfig& config);

}  // namespace plumbline::slam
