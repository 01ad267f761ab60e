// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bim/geometry/symmetric.h"
#include "bim/median.h"

namespace plumbline::slam {

namespace {

/// Right increment of axes R from sums in axes M about the robot: rho_M = R rho, phi_M = R phi.
Matrix6d block_rotation(const Eigen::Matrix3d& R_MR) {
  Matrix6d b = Matrix6d::Zero();
  b.topLeftCorner<3, 3>() = R_MR;
  b.bottomRightCorner<3, 3>() = R_MR;
  return b;
}

/// Takes the surfels' information from degenerate directions.
void leave_open(Normal6& normal, const Observability& seen) {
  normal.h = seen.kept.transpose() * normal.h * seen.kept;
  normal.g = seen.kept.transpose() * normal.g;
}

/// Adds a translation to the degenerate directions, as far as it is none of them.
void add_degenerate(Observability& seen, const Eigen::Vector3d& direction_R) {
  Vector6d direction = Vector6d::Zero();
  direction.head<3>() = direction_R;
  direction = seen.kept * direction;
  direction.tail<3>().setZero();
  constexpr double least = 0.5;  // it is one of them but for this
  if (direction.norm() < least) return;
  direction.normalize();
  const Matrix6d part = direction * direction.transpose();
  seen.kept = seen.kept * (Matrix6d::Identity() - part);
  seen.degenerate += part;
  seen.degenerate_directions.push_back(direction);
}

}  // namespace

void add_point(Normal6& sum, const Eigen::Vector3d& arm_M, const Eigen::Matrix3d& weight,
               const Eigen::Vector3d& weighted) {
  const Eigen::Matrix3d arm = hat(arm_M);  // J = [I, -arm]
  const Eigen::Matrix3d side = weight * arm;
  sum.h.topLeftCorner<3, 3>() += weight;
  sum.h.topRightCorner<3, 3>() -= side;
  sum.h.bottomRightCorner<3, 3>() -= arm * side;
  sum.g.head<3>() += weighted;
  sum.g.tail<3>() += arm_M.cross(weighted);
}

void to_right_increment(Normal6& sum, const Eigen::Matrix3d& R_MR) {
  sum.h.bottomLeftCorner<3, 3>() = sum.h.topRightCorner<3, 3>().transpose();
  const Matrix6d b = block_rotation(R_MR);
  sum.h = b.transpose() * sum.h * b;
  sum.g = b.transpose() * sum.g;
}

void add_prior(Normal6& normal, const PosePrior& prior, const Pose& X_MR) {
  normal.h += prior.information;
  normal.g += prior.information * log_se3(prior.X_MR.inverse() * X_MR);
  if (!prior.tilt) return;
  constexpr double tilt_cauchy_scale = 3.0;  // standard deviations; a robot without an IMU calls every slope level
  const TiltPrior& tilt = *prior.tilt;
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  const Eigen::Vector3d e = (R_MR * tilt.up_R - tilt.up_M) / tilt.sigma_rad;
  const Eigen::Matrix3d J = -R_MR * hat(tilt.up_R) / tilt.sigma_rad;
  const double w = 1.0 / (1.0 + e.squaredNorm() / (tilt_cauchy_scale * tilt_cauchy_scale));
  normal.h.bottomRightCorner<3, 3>() += w * J.transpose() * J;
  normal.g.tail<3>() += w * J.transpose() * e;
}

std::optional<Vector6d> solve_step(const Normal6& normal) {
  const Eigen::LDLT<Matrix6d> solver(normal.h);
  if (solver.info() != Eigen::Success || !solver.isPositive() || normal.inliers == 0.0) return std::nullopt;
  const Vector6d step = -solver.solve(normal.g);
  if (!step.allFinite()) return std::nullopt;
  return step;
}

Normal6 linearize(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                  const RegistrationConfig& config) {
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  const double slack = config.sigma_tangent_m * config.sigma_tangent_m;
  const double stiff = slack - config.sigma_normal_m * config.sigma_normal_m;
  const double scale2 = config.cauchy_scale * config.cauchy_scale;
  double terms = 1.0;
  Normal6 sum;
  for (const Surfel& surfel : surfels) {
    const Eigen::Vector3d arm_M = R_MR * surfel.mean_R;  // from the robot to the surfel
    const Eigen::Vector3d normal_M = R_MR * surfel.normal_R;
    const std::optional<SurfelMap::Voxel> voxel =
        map.find(arm_M + X_MR.t, normal_M, surfel.faces_sensor, config.min_normal_agreement);
    if (!voxel) continue;
    // Both covariances are slack I - stiff n n^T, the voxel's averaged over its surfels.
    const Eigen::Matrix3d covariance = 2.0 * slack * Eigen::Matrix3d::Identity() -
                                       stiff * (voxel->normals / voxel->n + normal_M * normal_M.transpose());
    const Eigen::Matrix3d information = covariance.inverse();
    const Eigen::Vector3d e = arm_M + X_MR.t - voxel->sum / voxel->n;
    const Eigen::Vector3d weighted = information * e;
    const double squared = e.dot(weighted);
    const double w = 1.0 / (1.0 + squared / scale2);
    add_point(sum, arm_M, w * information, w * weighted);
    terms *= 1.0 + squared / scale2;  // one logarithm for many
    if (terms > 1e100) sum.cost += 0.5 * scale2 * std::log(std::exchange(terms, 1.0));
    if (squared > 2.0 * scale2) continue;
    sum.inliers += 1.0;
    sum.squared += squared;
    sum.across.push_back(std::abs(normal_M.dot(e)));
  }
  sum.cost += 0.5 * scale2 * std::log(terms);
  to_right_increment(sum, R_MR);
  return sum;
}

Observability observability(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& X_MR,
                            const RegistrationConfig& config) {
  const Eigen::Matrix3d R_MR = X_MR.rotation();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen3;
  Normal6 sum;
  std::vector<double> distances;
  for (const Surfel& surfel : surfels) {
    const Eigen::Vector3d arm_M = R_MR * surfel.mean_R, normal_M = R_MR * surfel.normal_R;
    const std::optional<SurfelMap::Voxel> voxel =
        map.find(arm_M + X_MR.t, normal_M, surfel.faces_sensor, config.min_normal_agreement);
    if (!voxel) continue;
    // The map's normal is the mean of many; scatter of a surfel's own would pass for information.
    eigen3.computeDirect(voxel->normals);
    const Eigen::Vector3d mean_M = eigen3.eigenvectors().col(2);
    add_point(sum, arm_M, mean_M * mean_M.transpose(), Eigen::Vector3d::Zero());
    distances.push_back(surfel.mean_R.norm());
  }
  Observability result;
  constexpr std::size_t fewest = 10;  // six directions and some more
  if (config.least_eigenvalue <= 0.0) return result;
  if (distances.size() < fewest) {
    result.least_eigenvalue = 0.0;
    result.kept.setZero();
    result.degenerate.setIdentity();
    for (int k = 0; k < 6; ++k) result.degenerate_directions.push_back(Vector6d::Unit(k));
    return result;
  }
  to_right_increment(sum, R_MR);
  const double distance = std::max(upper_median(distances), 0.1);
  Vector6d unit;
  unit << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(1.0 / distance);
  const Matrix6d scaled = unit.asDiagonal() * sum.h * unit.asDiagonal() / static_cast<double>(distances.size());
  const SymmetricEigen<6> eigen = symmetric_eigen(scaled);
  result.least_eigenvalue = eigen.values(0);
  for (int k = 0; k < 6 && eigen.values(k) < config.least_eigenvalue; ++k) {
    const Vector6d direction = unit.cwiseProduct(eigen.vectors.col(k));
    const Vector6d part = eigen.vectors.col(k).cwiseQuotient(unit);
    result.kept -= direction * part.transpose();
    result.degenerate += part * part.transpose();
    result.degenerate_directions.push_back(direction);
  }
  return result;
}

Registration align(std::span<const Surfel> surfels, const SurfelMap& map, const Pose& start,
                   const std::optional<PosePrior>& prior, const RegistrationConfig& config,
                   const AdditionalFactors& additional, double degenerate_sigma_m, const std::optional<Pose>& expected,
                   const AdditionalFactors& where_degenerate, const std::optional<Eigen::Vector3d>& moving_R) {
  Registration result;
  result.X_MR = start;
  result.moving_R = moving_R;
  Observability seen = observability(surfels, map, start, config);
  if (moving_R) add_degenerate(seen, *moving_R);
  result.least_eigenvalue = seen.least_eigenvalue;
  result.degenerate_directions = static_cast<int>(seen.degenerate_directions.size());
  result.open = seen.degenerate;
  const PosePrior hold{expected.value_or(start), seen.degenerate / (degenerate_sigma_m * degenerate_sigma_m),
                       std::nullopt};
  Normal6 normal;
  while (result.iterations < config.max_iterations && !result.converged) {
    ++result.iterations;
    normal = linearize(surfels, map, result.X_MR, config);
    if (!seen.degenerate_directions.empty()) leave_open(normal, seen);
    if (additional) {
      Normal6 terms = additional(result.X_MR);
      if (moving_R) leave_open(terms, seen);
      normal.h += terms.h;
      normal.g += terms.g;
    }
    if (where_degenerate && !seen.degenerate_directions.empty()) {
      const Normal6 more = where_degenerate(result.X_MR);
      const Matrix6d onto = Matrix6d::Identity() - seen.kept;
      normal.h += onto.transpose() * more.h * onto;
      normal.g += onto.transpose() * more.g;
    }
    result.information = normal.h;
    if (!seen.degenerate_directions.empty()) add_prior(normal, hold, result.X_MR);
    if (prior) add_prior(normal, *prior, result.X_MR);
    const std::optional<Vector6d> step = solve_step(normal);
    if (!step) break;
    result.X_MR = result.X_MR * exp_se3(*step);
    result.converged =
        step->head<3>().norm() < config.translation_epsilon_m && step->tail<3>().norm() < config.rotation_epsilon_rad;
  }
  if (!seen.degenerate_directions.empty()) {
    Matrix6d known = prior ? prior->information : Matrix6d(Matrix6d::Zero());
    if (additional && !moving_R) known += additional(result.X_MR).h;
    constexpr double known_m = 0.015;  // four edges of 3 cm; a stray one or two tell nothing
    for (const Vector6d& direction : seen.degenerate_directions)
      if (direction.dot(known * direction) * known_m * known_m < 1.0) result.unobserved.push_back(direction);
    result.unobserved_directions = static_cast<int>(result.unobserved.size());
  }
  if (!surfels.empty()) result.matched = normal.inliers / static_cast<double>(surfels.size());
  if (!normal.across.empty()) result.residual_m = 1.4826 * upper_median(normal.across);
  if (normal.inliers > 0.0) result.rms = std::sqrt(normal.squared / normal.inliers);
  return result;
}

}  // namespace plumbline::slam
