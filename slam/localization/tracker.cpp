// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/tracker.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "slam/graph/factors.h"
#include "slam/localization/associate.h"

namespace plumbline::slam {

namespace {

/// Normal equations over a window of poses, 6 increments each, and the LiDAR's range bias, which comes last.
class WindowProblem {
 public:
  explicit WindowProblem(std::size_t poses)
      : H_(Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(poses) + 1, 6 * static_cast<Eigen::Index>(poses) + 1)),
        b_(Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(poses) + 1)) {}

  /// Residual e with Jacobian J towards pose i; sigmas by row; Huber in whitened length, 0: none.
  void add(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& e, const Eigen::VectorXd& sigmas,
           double huber) {
    add_with_bias(i, J, Eigen::VectorXd::Zero(e.size()), e, sigmas, huber);
  }
  /// J_bias: towards the range bias.
  void add_with_bias(std::size_t i, const Eigen::MatrixXd& J, const Eigen::VectorXd& J_bias, Eigen::VectorXd e,
                     const Eigen::VectorXd& sigmas, double huber) {
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
  void add_bias_prior(double bias, double sigma) {
    const Eigen::Index last = b_.size() - 1;
    H_(last, last) += 1.0 / (sigma * sigma);
    b_[last] -= bias / (sigma * sigma);
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

/// How much of a range bias shows in the distance of an observed wall: cosine of the beams' incidence.
double bias_share(const PlaneObservation& observed) {
  const double range = observed.centroid_R.norm();
  return range > 0.0 ? std::min(1.0, std::abs(observed.plane_R.d) / range) : 1.0;
}

/// Residual of an observed wall, its distance corrected by the range bias.
PlaneResidual wall_residual(const TrackedPose& pose, const WallLink& link, const StoreyIndex& storey, double bias) {
  const Plane plane_I = plane_of(storey.lines[static_cast<std::size_t>(link.line)]);
  PlaneResidual residual = plane_residual(pose.X_IR, plane_I, link.observed.plane_R);
  residual.e[2] += bias_share(link.observed) * bias;
  return residual;
}

/// Pose-plane factors to the walls and the floor of the plan, which stand still.
void add_planes(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey, double bias,
                const TrackerConfig& config) {
  for (const WallLink& link : pose.walls) {
    const PlaneResidual residual = wall_residual(pose, link, storey, bias);
    problem.add_with_bias(i, residual.J_pose, Eigen::Vector3d(0.0, 0.0, bias_share(link.observed)), residual.e,
                          plane_sigmas(link.observed, config.plane_angle_sigma, config.plane_offset_sigma_m),
                          config.huber);
  }
  for (const PlaneObservation& floor : pose.floor) {
    const Plane floor_I{Eigen::Vector3d::UnitZ(), -storey.floor_z};
    const PlaneResidual residual = plane_residual(pose.X_IR, floor_I, floor.plane_R);
    problem.add(i, residual.J_pose, residual.e,
                plane_sigmas(floor, config.floor_angle_sigma, config.floor_offset_sigma_m), config.huber);
  }
}

/// The robot stands on what the plan has below it: floor, landing or step.
void add_ground(WindowProblem& problem, std::size_t i, const TrackedPose& pose, const StoreyIndex& storey,
                double standing_m, const TrackerConfig& config) {
  const std::optional<double> ground = storey.structure->ground_below(pose.X_IR.t, standing_m + config.ground_gate_m);
  if (!ground) return;
  const double e = pose.X_IR.t.z() - standing_m - *ground;
  if (std::abs(e) > config.ground_gate_m) return;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(1, 6);
  J.leftCols<3>() = pose.X_IR.rotation().row(2);
  problem.add(i, J, Eigen::VectorXd::Constant(1, e), Eigen::VectorXd::Constant(1, config.ground_sigma_m), 0.0);
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

/// Whitens e of covariance P: (L^-1) with P = L L'.
Eigen::Matrix2d inverse_root(const Eigen::Matrix2d& P) {
  const Eigen::Matrix2d root = P.llt().matrixL();
  return root.inverse();
}

}  // namespace

Pose PlanTracker::X_IO() const { return window_.back().X_IR * window_.back().X_OR.inverse(); }

void PlanTracker::start(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_IR,
                        const Eigen::Matrix2d& position_covariance) {
  const double least = config_.anchor_sigma_m * config_.anchor_sigma_m;
  anchor_covariance_ = position_covariance + least * Eigen::Matrix2d::Identity();
  covariance_.topLeftCorner<2, 2>() = anchor_covariance_;
  window_.assign(1, associate(scan, planes, X_IR));
  anchor_X_IR_ = X_IR;
  optimise();
}

void PlanTracker::carry_anchor_covariance(const TrackedPose& from, const TrackedPose& to) {
  // A wall that stands off the plan shifts all its observations alike: they take back no more than to this.
  const double least = config_.anchor_sigma_m * config_.anchor_sigma_m;
  Eigen::Matrix2d& P = anchor_covariance_;
  for (const WallLink& link : from.walls) {
    const Eigen::Vector2d& n = storey_.lines[static_cast<std::size_t>(link.line)].n;
    const Eigen::Vector2d Pn = P * n;
    const double variance = n.dot(Pn);
    if (variance > least) P -= (variance - least) / (variance * variance) * Pn * Pn.transpose();
  }
  const double grown = config_.drift_per_m * (to.X_OR.t - from.X_OR.t).norm();
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(P).eigenvalues()[1];
  P += (grown * grown + 2.0 * grown * std::sqrt(largest)) * Eigen::Matrix2d::Identity();
}

std::optional<Eigen::Vector2d> PlanTracker::open_direction() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance_.topLeftCorner<2, 2>());
  if (std::sqrt(axes.eigenvalues()[1]) < config_.anchor_sigma_m) return std::nullopt;
  return axes.eigenvectors().col(1);
}

// The odometry within the window is good: all of it is off alike.
void PlanTracker::correct_along(const Eigen::Vector2d& direction_I, double off_m, double variance) {
  const auto taken_in = [&](Eigen::Ref<Eigen::Matrix2d> P) {
    const Eigen::Vector2d gain = P * direction_I / (direction_I.dot(P * direction_I) + variance);
    P -= gain * (direction_I.transpose() * P);
    return gain;
  };
  (void)taken_in(anchor_covariance_);
  const Eigen::Vector2d gain = taken_in(covariance_.topLeftCorner<2, 2>());
  const Eigen::Vector2d shift = gain * off_m;
  for (TrackedPose& pose : window_) pose.X_IR.t.head<2>() += shift;
  anchor_X_IR_.t.head<2>() += shift;
}

std::vector<TrackedPose> PlanTracker::update(const LocalizationScan& scan,
                                             const std::vector<PlaneObservation>& planes) {
  window_.push_back(associate(scan, planes, pose(scan.X_OR)));
  std::vector<TrackedPose> left;
  if (static_cast<int>(window_.size()) > config_.window) {
    left.push_back(window_.front());
    carry_anchor_covariance(window_[0], window_[1]);
    window_.pop_front();
    anchor_X_IR_ = window_.front().X_IR;
  }
  optimise();
  return left;
}

void PlanTracker::change_storey(StoreyIndex storey) {
  storey_ = std::move(storey);
  for (TrackedPose& pose : window_) {
    pose.walls.clear();
    pose.floor.clear();
    pose.room = storey_.room_at(pose.X_IR.t.head<2>());
  }
}

TrackedPose PlanTracker::associate(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes,
                                   const Pose& X_IR) const {
  TrackedPose pose;
  pose.stamp = scan.stamp;
  pose.X_OR = scan.X_OR;
  pose.X_IR = X_IR;
  pose.room = storey_.room_at(X_IR.t.head<2>());
  pose.walls = associate_walls(storey_, scan, planes, X_IR, covariance_.topLeftCorner<2, 2>(), config_);
  pose.floor = find_floor(scan, planes, config_);
  const Plane floor_I{Eigen::Vector3d::UnitZ(), -storey_.floor_z};
  std::erase_if(pose.floor, [&](const PlaneObservation& floor) {
    return std::abs(plane_residual(X_IR, floor_I, floor.plane_R).e[2]) > config_.floor_gate_m;
  });
  return pose;
}

void PlanTracker::optimise() {
  Vector6d hold;
  hold << config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_rad,
      config_.anchor_sigma_rad, config_.anchor_sigma_rad;
  for (int k = 0; k < config_.iterations; ++k) {
    WindowProblem problem(window_.size());
    problem.add_bias_prior(range_bias_m_, config_.range_bias_sigma_m);
    const PoseResidual held = pose_residual(anchor_X_IR_, window_.front().X_IR, Pose{});
    Matrix6d unheld = Matrix6d::Identity();
    unheld.topLeftCorner<2, 2>() =
        config_.anchor_sigma_m * inverse_root(anchor_covariance_) * anchor_X_IR_.rotation().topLeftCorner<2, 2>();
    problem.add(0, unheld * held.J_j, unheld * held.e, hold, 0.0);
    for (std::size_t i = 0; i < window_.size(); ++i) {
      add_planes(problem, i, window_[i], storey_, range_bias_m_, config_);
      add_rooms(problem, i, window_[i], storey_, config_);
      add_ground(problem, i, window_[i], storey_, standing_m_, config_);
      if (i + 1 == window_.size()) continue;
      const Pose X_ij = window_[i].X_OR.inverse() * window_[i + 1].X_OR;
      problem.add_between(i, pose_residual(window_[i].X_IR, window_[i + 1].X_IR, X_ij), odometry_sigmas(X_ij, config_));
    }
    const Eigen::VectorXd step = problem.solve();
    for (std::size_t i = 0; i < window_.size(); ++i)
      window_[i].X_IR = increment(window_[i].X_IR, step.segment<6>(6 * static_cast<Eigen::Index>(i)));
    range_bias_m_ += step[step.size() - 1];
  }
  covariance_ = covariance_of_newest();
}

double PlanTracker::wall_tolerance() const {
  struct Mean {
    double sum = 0.0;
    int count = 0;
  };
  std::map<int, Mean> of_line;
  for (const TrackedPose& pose : window_)
    for (const WallLink& link : pose.walls) {
      Mean& mean = of_line[link.line];
      mean.sum += std::clamp(wall_residual(pose, link, storey_, range_bias_m_).e[2], -config_.wall_residual_max_m,
                             config_.wall_residual_max_m);
      ++mean.count;
    }
  double squares = config_.wall_tolerance_weight * config_.wall_tolerance_m * config_.wall_tolerance_m;
  for (const auto& [line, mean] : of_line) squares += std::pow(mean.sum / mean.count, 2);
  constexpr double fitted = 4.0;  // x, y, yaw and the range bias
  const double freedom = config_.wall_tolerance_weight + std::max(0.0, static_cast<double>(of_line.size()) - fitted);
  return std::sqrt(squares / freedom);
}

Eigen::Matrix3d PlanTracker::covariance_of_newest() const {
  const TrackedPose& pose = window_.back();
  const double tolerance = wall_tolerance();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner<2, 2>() = anchor_covariance_.inverse();
  information(2, 2) = 1.0 / (config_.anchor_sigma_rad * config_.anchor_sigma_rad);
  const auto add = [&](const Eigen::Vector3d& J, double sigma) { information += J * J.transpose() / (sigma * sigma); };
  std::set<int> counted;
  // All walls of the window: those out of sight now still hold the pose by odometry.
  for (auto it = window_.rbegin(); it != window_.rend(); ++it)
    for (const WallLink& link : it->walls) {
      if (!counted.insert(link.line).second) continue;
      const Eigen::Vector2d& n = storey_.lines[static_cast<std::size_t>(link.line)].n;
      const Eigen::Vector2d arm = (it->X_IR * link.observed.centroid_R - pose.X_IR.t).head<2>();
      add({n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y()}, tolerance);
      const double length = (link.observed.p1_R - link.observed.p0_R).norm();
      if (length > 0.0) add({0.0, 0.0, 1.0}, std::sqrt(12.0) * tolerance / length + config_.wall_angle_min);
    }
  Eigen::Matrix3d P = information.inverse();
  P.topLeftCorner<2, 2>() += config_.position_sigma_min_m * config_.position_sigma_min_m * Eigen::Matrix2d::Identity();
  P(2, 2) += config_.yaw_sigma_min * config_.yaw_sigma_min;
  return P;
}

}  // namespace plumbline::slam
