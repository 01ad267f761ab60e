// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/odometry/surfels.h"

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

/// Belief about the pose before registration: X_MR and the information of its right increment (rho, phi).
struct PosePrior {
  Pose X_MR;
  Matrix6d information = Matrix6d::Zero();
};

struct Registration {
  Pose X_MR;
  Matrix6d information = Matrix6d::Zero();  ///< Gauss-Newton Hessian of the surfels alone, of the right increment
                                            ///< (rho in m, phi in rad); counts every surfel as independent
  double matched = 0.0;                     ///< share of the surfels that met a voxel and are not outliers, 0 to 1
  double rms = 0.0;                         ///< of the inliers' Mahalanobis distances; 0.3 to 0.8 for a good match
  int iterations = 0;
  bool converged = false;
};

/// Voxelized GICP: minimises sum rho(e^T (C_voxel + R C_surfel R^T)^-1 e) with e the way from the moved surfel to the
/// mean of the voxel it falls in, plus the prior if any, by Gauss-Newton on SE(3) from `start`.
[[nodiscard]] Registration align(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& start,
                                 const std::optional<PosePrior>& prior, const RegistrationConfig& config);

/// Cost of align() at X_MR and its gradient and Gauss-Newton Hessian by the right increment, robust weights included.
struct Normal6 {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0.0;
  double inliers = 0.0;
  double squared = 0.0;  ///< sum over the inliers of the squared Mahalanobis distance
};
[[nodiscard]] Normal6 linearize(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                                const RegistrationConfig& config);

struct VgicpConfig {
  SurfelConfig surfels;
  RegistrationConfig registration;
  double map_voxel_m = 0.5;
  double keyframe_distance_m = 0.5;  ///< a scan enters the local map after this way ...
  double keyframe_angle_rad = 0.35;  ///< ... or this turn
  int map_keyframes = 20;            ///< the local map holds the latest so many
  bool odometry_prior = true;        ///< leg odometry as a weak factor; it holds the way along bare corridors
  double prior_m = 0.004;            ///< standard deviation of an increment ...
  double prior_per_m = 0.05;         ///< ... plus this times its length
  double prior_rad = 0.004;          ///< the same for rotation
  double prior_per_rad = 0.05;

  template <class V>
  void visit(V& v) {
    v("surfels", surfels);
    v("registration", registration);
    v("map_voxel_m", map_voxel_m, Field{.min = 0.05});
    v("keyframe_distance_m", keyframe_distance_m, Field{.min = 0.01});
    v("keyframe_angle_rad", keyframe_angle_rad, Field{.min = 0.01});
    v("map_keyframes", map_keyframes, Field{.min = 1});
    v("odometry_prior", odometry_prior);
    v("prior_m", prior_m, Field{.min = 1e-5});
    v("prior_per_m", prior_per_m, Field{.min = 0.0});
    v("prior_rad", prior_rad, Field{.min = 1e-6});
    v("prior_per_rad", prior_per_rad, Field{.min = 0.0});
  }
};

/// LiDAR odometry: each scan against a local map of the latest keyframes. M starts at the first pose: X_MR = identity.
class VgicpOdometry {
 public:
  explicit VgicpOdometry(const VgicpConfig& config);

  /// X_OR: leg odometry at scan.stamp; only its increments are used, as start and as prior.
  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR);
  /// True when the last scan entered the local map.
  [[nodiscard]] bool is_keyframe() const { return is_keyframe_; }

 private:
  struct Keyframe {
    std::vector<Surfel> surfels;
    Pose X_MR;
  };

  [[nodiscard]] PosePrior predict(const Pose& X_OR) const;
  void insert(std::vector<Surfel> surfels, const Pose& X_MR);

  VgicpConfig config_;
  SurfelMap map_;
  std::deque<Keyframe> keyframes_;
  Pose X_MR_;
  Pose X_OR_;
  bool is_keyframe_ = false;
};

}  // namespace plumbline::slam
