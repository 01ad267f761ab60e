// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/tracker_factors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/geometry/symmetric.h"
#include "slam/localization/associate.h"

namespace plumbline::slam {

namespace {

void whiten(Eigen::MatrixXd& J, Eigen::VectorXd& e, const Eigen::VectorXd& sigmas, double huber) {
  for (Eigen::Index r = 0; r < e.size(); ++r) {
    J.row(r) /= sigmas[r];
    e[r] /= sigmas[r];
  }
  const double length = e.norm();
  if (huber <= 0.0 || length <= huber) return;
  const double scale = std::sqrt(huber / length);
  J *= scale;
  e *= scale;
}

Eigen::Vector3d plane_sigmas(const PlaneObservation& observed, double angle, double offset) {
  const auto join = [](double variance, double sigma) { return std::sqrt(variance + sigma * sigma); };
  return {join(observed.covariance(0, 0), angle), join(observed.covariance(1, 1), angle),
          join(observed.covariance(2, 2), offset)};
}

}  // namespace

WindowProblem::WindowProblem(std::size_t poses)
    : H_(Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(poses) + 1, 6 * static_cast<Eigen::Index>(poses) + 1)),
      b_(Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(poses) + 1)) {}

void WindowProblem::add(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& e,
                        const Eigen::VectorXd& sigmas, double huber) {
  add_with_bias(i, J, Eigen::VectorXd::Zero(e.size()), e, sigmas, huber);
}

void WindowProblem::add_with_bias(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& J_bias,
                                  Eigen::VectorXd e, const Eigen::VectorXd& sigmas, double huber) {
  Eigen::MatrixXd J_both(J.rows(), 7);
  J_both << J, J_bias;
  whiten(J_both, e, sigmas, huber);
  const Eigen::Index k = 6 * static_cast<Eigen::Index>(i), last = b_.size() - 1;
  const Eigen::Matrix<double, 7, 7> JtJ = J_both.transpose() * J_both;
  const Eigen::Matrix<double, 7, 1> Jte = J_both.transpose() * e;
  H_.block<6, 6>(k, k) += JtJ.topLeftCorner<6, 6>();
  H_.block<6, 1>(k, last) += JtJ.topRightCorner<6, 1>();
  H_.block<1, 6>(last, k) += JtJ.bottomLeftCorner<1, 6>();
  H_(last, last) += JtJ(6, 6);
  b_.segment<6>(k) -= Jte.head<6>();
  b_[last] -= Jte[6];
}

void WindowProblem::add_bias_prior(double off, double sigma) {
  const Eigen::Index last = b_.size() - 1;
  H_(last, last) += 1.0 / (sigma * sigma);
  b_[last] -= off / (sigma * sigma);
}

void WindowProblem::add_between(std::size_t i, const PoseResidual& residual, const Vector6d& sigmas) {
  Eigen::MatrixXd J(6, 12);
  J << residual.J_i, residual.J_j;
  Eigen::VectorXd e = residual.e;
  whiten(J, e, sigmas, 0.0);
  const Eigen::Index k = 6 * static_cast<Eigen::Index>(i);
  H_.block<12, 12>(k, k) += J.transpose() * J;
  b_.segment<12>(k) -= J.transpose() * e;
}

Eigen::VectorXd WindowProblem::solve() const { return solve_ldlt(H_, b_); }

double bias_share(const PlaneObservation& observed) {
  const double range = observed.centroid_R.norm();
  return range > 0.0 ? std::min(1.0, std::abs(observed.plane_R.d) / range) : 1.0;
}

PlaneResidual wall_residual(const TrackedPose& pose, const WallLink& link, const StoreyIndex& storey, double bias) {
  const Plane plane_I = plane_of(storey.lines[static_cast<std::size_t>(link.line)]);
  PlaneResidual residual = plane_residual(pose.X_IR, plane_I, link.observed.plane_R);
  residual.e[2] += bias_share(link.observed) * bias;
  return residual;
}

Eigen::Vector3d wall_sigmas(const WallLink& link, const TrackerConfig& config) {
  return plane_sigmas(link.observed, config.plane_angle_sigma, config.plane_offset_sigma_m);
}

double wall_weight(const TrackedPose& pose, const WallLink& link, const StoreyIndex& storey, double bias,
                   const Eigen::Matrix2d& covariance, const TrackerConfig& config) {
  const Eigen::Vector2d& n = storey.lines[static_cast<std::size_t>(link.line)].n;
  Eigen::Vector3d sigmas = wall_sigmas(link, config);
  sigmas[2] = std::sqrt(sigmas[2] * sigmas[2] + n.dot(covariance * n));
  const Eigen::Vector3d whitened = wall_residual(pose, link, storey, bias).e.cwiseQuotient(sigmas);
  const double sigma_count = whitened[2] > 0.0 ? config.clutter_sigmas : config.misplaced_sigmas;
  const double scale = sigma_count * sigma_count;
  const double share = scale / (scale + whitened.squaredNorm());
  return share * share;
}

void add_planes(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey, double bias,
                const TrackerConfig& config) {
  for (const WallLink& link : pose.walls) {
    const PlaneResidual residual = wall_residual(pose, link, storey, bias);
    problem.add_with_bias(i, residual.J_pose, Eigen::Vector3d(0.0, 0.0, bias_share(link.observed)), residual.e,
                          wall_sigmas(link, config) / std::sqrt(link.weight), 0.0);
  }
  for (const PlaneObservation& floor : pose.floor) {
    const PlaneResidual residual = plane_residual(pose.X_IR, pose.floor_I, floor.plane_R);
    problem.add(i, residual.J_pose, residual.e,
                plane_sigmas(floor, config.floor_angle_sigma, config.floor_offset_sigma_m), config.huber);
  }
}

void add_ground(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
                double standing_m, const TrackerConfig& config) {
  // From above any step, also where R itself lies on the floor.
  constexpr double least_m = 0.4;
  const double lift = std::max(0.0, least_m - standing_m);
  const std::optional<double> ground = storey.structure->ground_below(pose.X_IR.t + lift * Eigen::Vector3d::UnitZ(),
                                                                      standing_m + lift + config.ground_gate_m);
  if (!ground) return;
  const double e = pose.X_IR.t.z() - standing_m - *ground;
  if (std::abs(e) > config.ground_gate_m) return;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(1, 6);
  J.leftCols<3>() = pose.X_IR.rotation().row(2);
  problem.add(i, J, Eigen::VectorXd::Constant(1, e), Eigen::VectorXd::Constant(1, config.ground_sigma_m), 0.0);
}

void add_rooms(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
               const TrackerConfig& config) {
  for (const WallPair& pair : opposed_pairs(storey, pose, config)) {
    const WallLink& a = pose.walls[static_cast<std::size_t>(pair.a)];
    const WallLink& b = pose.walls[static_cast<std::size_t>(pair.b)];
    const PlaneResidual to_a = wall_residual(pose, a, storey, 0.0), to_b = wall_residual(pose, b, storey, 0.0);
    const Eigen::VectorXd e = Eigen::VectorXd::Constant(1, 0.5 * (to_a.e[2] - to_b.e[2]));
    const Eigen::MatrixXd J = 0.5 * (to_a.J_pose.row(2) - to_b.J_pose.row(2));
    const double fit = 0.25 * (a.observed.covariance(2, 2) + b.observed.covariance(2, 2));
    const double variance = (fit + config.pair_sigma_m * config.pair_sigma_m) / std::min(a.weight, b.weight);
    problem.add(i, J, e, Eigen::VectorXd::Constant(1, std::sqrt(variance)), config.huber);
  }
}

Eigen::Vector2d gain_along(const Eigen::Matrix2d& covariance, const Eigen::Vector2d& direction, double variance) {
  return covariance * direction / (direction.dot(covariance * direction) + variance);
}

Eigen::Matrix3d corrected_along(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& direction, double variance) {
  Eigen::Vector3d gain = Eigen::Vector3d::Zero();
  gain.head<2>() = gain_along(covariance.topLeftCorner<2, 2>(), direction, variance);
  const Eigen::RowVector3d H(direction.x(), direction.y(), 0.0);
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * H;
  return kept * covariance * kept.transpose() + variance * gain * gain.transpose();
}

Vector6d odometry_sigmas(const Pose& X_ij, double waited_s, const TrackerConfig& config) {
  const double walked = X_ij.t.norm();
  const double turned = log_so3(X_ij.q).norm();
  const double trans =
      config.odometry_min_m + config.odometry_trans_per_m * walked + config.odometry_standing_m_per_s * waited_s;
  const double rot =
      config.odometry_min_rad + config.odometry_rot_per_rad * turned + config.odometry_standing_rad_per_s * waited_s;
  Vector6d sigmas;
  sigmas << trans, trans, trans + config.odometry_height_per_m * walked, rot, rot, rot;
  return sigmas;
}

}  // namespace plumbline::slam
