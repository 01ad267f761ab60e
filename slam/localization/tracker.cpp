// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/graph/factors.h"
#include "slam/localization/associate.h"

namespace plumbline::slam {

namespace {

/// Normal equations over a window of poses, 6 increments each.
class WindowProblem {
 public:
  explicit WindowProblem(std::size_t poses)
      : H_(Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(poses), 6 * static_cast<Eigen::Index>(poses))),
        b_(Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(poses))) {}

  /// Residual e with Jacobian J towards pose i; sigmas by row; Huber in whitened length, 0: none.
  void add(std::size_t i, Eigen::MatrixXd J, Eigen::VectorXd e, const Eigen::VectorXd& sigmas, double huber) {
    whiten(J, e, sigmas, huber);
    const Eigen::Index k = 6 * static_cast<Eigen::Index>(i);
    H_.block<6, 6>(k, k) += J.transpose() * J;
    b_.segment<6>(k) -= J.transpose() * e;
  }

  void add_between(std::size_t i, const PoseResidual& residual, const Vector6d& sigmas) {
    Eigen::MatrixXd J(6, 12);
    J << residual.J_i, residual.J_j;
    Eigen::VectorXd e = residual.e;
    whiten(J, e, sigmas, 0.0);
    const Eigen::Index k = 6 * static_cast<Eigen::Index>(i);
    H_.block<12, 12>(k, k) += J.transpose() * J;
    b_.segment<12>(k) -= J.transpose() * e;
  }

  [[nodiscard]] Eigen::VectorXd solve() const { return H_.ldlt().solve(b_); }
  /// Covariance of the last pose's increment.
  [[nodiscard]] Matrix6d last_covariance() const {
    const Eigen::Index n = H_.rows();
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(n, 6);
    unit.bottomRows<6>().setIdentity();
    return H_.ldlt().solve(unit).bottomRows<6>();
  }

 private:
  static void whiten(Eigen::MatrixXd& J, Eigen::VectorXd& e, const Eigen::VectorXd& sigmas, double huber) {
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

  Eigen::MatrixXd H_;
  Eigen::VectorXd b_;
};

Eigen::Vector3d plane_sigmas(const PlaneObservation& observed, double angle, double offset) {
  const auto join = [](double variance, double sigma) { return std::sqrt(variance + sigma * sigma); };
  return {join(observed.covariance(0, 0), angle), join(observed.covariance(1, 1), angle),
          join(observed.covariance(2, 2), offset)};
}

/// Pose-plane factors to the walls and the floor of the plan, which stand still.
void add_planes(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
                const TrackerConfig& config) {
  for (const WallLink& link : pose.walls) {
    const Plane plane_I = plane_of(storey.lines[static_cast<std::size_t>(link.line)]);
    const PlaneResidual residual = plane_residual(pose.X_IR, plane_I, link.observed.plane_R);
    problem.add(i, residual.J_pose, residual.e,
                plane_sigmas(link.observed, config.plane_angle_sigma, config.plane_offset_sigma_m), config.huber);
  }
  for (const PlaneObservation& floor : pose.floor) {
    const Plane floor_I{Eigen::Vector3d::UnitZ(), -storey.floor_z};
    const PlaneResidual residual = plane_residual(pose.X_IR, floor_I, floor.plane_R);
    problem.add(i, residual.J_pose, residual.e,
                plane_sigmas(floor, config.floor_angle_sigma, config.floor_offset_sigma_m), config.huber);
  }
}

/// Room factors [bavle2023, eq. 7-8] with the room held by the plan: the robot's offset from the middle of two opposed
/// walls, as seen and as planned. A range bias shifts both walls alike and cancels.
void add_rooms(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
               const TrackerConfig& config) {
  for (const WallPair& pair : opposed_pairs(storey, pose, config)) {
    const WallLink& a = pose.walls[static_cast<std::size_t>(pair.a)];
    const WallLink& b = pose.walls[static_cast<std::size_t>(pair.b)];
    const auto offset = [&](const WallLink& link) {
      return plane_residual(pose.X_IR, plane_of(storey.lines[static_cast<std::size_t>(link.line)]),
                            link.observed.plane_R);
    };
    const PlaneResidual to_a = offset(a), to_b = offset(b);
    const Eigen::VectorXd e = Eigen::VectorXd::Constant(1, 0.5 * (to_a.e[2] - to_b.e[2]));
    const Eigen::MatrixXd J = 0.5 * (to_a.J_pose.row(2) - to_b.J_pose.row(2));
    const double fit = 0.25 * (a.observed.covariance(2, 2) + b.observed.covariance(2, 2));
    const double sigma = std::sqrt(fit + config.pair_sigma_m * config.pair_sigma_m);
    problem.add(i, J, e, Eigen::VectorXd::Constant(1, sigma), config.huber);
  }
}

Vector6d odometry_sigmas(const Pose& X_ij, const TrackerConfig& config) {
  const double walked = X_ij.t.norm();
  const double turned = log_so3(X_ij.q).norm();
  const double trans = config.odometry_min_m + config.odometry_trans_per_m * walked;
  const double rot = config.odometry_min_rad + config.odometry_rot_per_rad * turned;
  Vector6d sigmas;
  sigmas << trans, trans, trans + config.odometry_height_per_m * walked, rot, rot, rot;
  return sigmas;
}

}  // namespace

Pose PlanTracker::X_IO() const { return window_.back().X_IR * window_.back().X_OR.inverse(); }

void PlanTracker::start(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_IR) {
  window_.assign(1, associate(scan, planes, X_IR));
  anchor_X_IR_ = X_IR;
  optimise();
}

std::vector<TrackedPose> PlanTracker::update(const LocalizationScan& scan,
                                             const std::vector<PlaneObservation>& planes) {
  window_.push_back(associate(scan, planes, pose(scan.X_OR)));
  std::vector<TrackedPose> left;
  if (static_cast<int>(window_.size()) > config_.window) {
    left.push_back(window_.front());
    window_.pop_front();
    anchor_X_IR_ = window_.front().X_IR;
  }
  optimise();
  return left;
}

TrackedPose PlanTracker::associate(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes,
                                   const Pose& X_IR) const {
  TrackedPose pose;
  pose.stamp = scan.stamp;
  pose.X_OR = scan.X_OR;
  pose.X_IR = X_IR;
  pose.room = storey_.room_at(X_IR.t.head<2>());
  pose.walls = associate_walls(storey_, scan, planes, X_IR, config_);
  pose.floor = find_floor(scan, planes, config_);
  return pose;
}

void PlanTracker::optimise() {
  Vector6d hold;
  hold << config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_rad,
      config_.anchor_sigma_rad, config_.anchor_sigma_rad;
  for (int k = 0; k < config_.iterations; ++k) {
    WindowProblem problem(window_.size());
    const PoseResidual held = pose_residual(anchor_X_IR_, window_.front().X_IR, Pose{});
    problem.add(0, held.J_j, held.e, hold, 0.0);
    for (std::size_t i = 0; i < window_.size(); ++i) {
      add_planes(problem, i, window_[i], storey_, config_);
      add_rooms(problem, i, window_[i], storey_, config_);
      if (i + 1 == window_.size()) continue;
      const Pose X_ij = window_[i].X_OR.inverse() * window_[i + 1].X_OR;
      problem.add_between(i, pose_residual(window_[i].X_IR, window_[i + 1].X_IR, X_ij), odometry_sigmas(X_ij, config_));
    }
    const Eigen::VectorXd step = problem.solve();
    for (std::size_t i = 0; i < window_.size(); ++i)
      window_[i].X_IR = increment(window_[i].X_IR, step.segment<6>(6 * static_cast<Eigen::Index>(i)));
    if (k + 1 < config_.iterations) continue;
    const Eigen::Matrix3d R = window_.back().X_IR.rotation();
    const Matrix6d P = problem.last_covariance();
    covariance_.topLeftCorner<2, 2>() = (R * P.topLeftCorner<3, 3>() * R.transpose()).topLeftCorner<2, 2>();
    covariance_.topRightCorner<2, 1>() = (R * P.block<3, 1>(0, 5)).head<2>();
    covariance_.bottomLeftCorner<1, 2>() = covariance_.topRightCorner<2, 1>().transpose();
    covariance_(2, 2) = P(5, 5);
  }
}

}  // namespace plumbline::slam
