// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bim/geometry/symmetric.h"
#include "slam/graph/factors.h"
#include "slam/localization/associate.h"
#include "slam/localization/tracker_factors.h"

namespace plumbline::slam {

namespace {

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
  measure_walls();
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
  const double largest = symmetric_eigen(P).values[1];
  P += (grown * grown + 2.0 * grown * std::sqrt(largest)) * Eigen::Matrix2d::Identity();
}

std::optional<Eigen::Vector2d> PlanTracker::open_direction() const {
  const auto axes = symmetric_eigen(Eigen::Matrix2d(covariance_.topLeftCorner<2, 2>()));
  if (std::sqrt(axes.values[1]) < config_.anchor_sigma_m) return std::nullopt;
  return axes.vectors.col(1);
}

// The odometry within the window is good: all of it is off alike.
void PlanTracker::correct_along(const Eigen::Vector2d& direction_I, double off_m, double variance) {
  anchor_covariance_ -=
      gain_along(anchor_covariance_, direction_I, variance) * (direction_I.transpose() * anchor_covariance_);
  const Eigen::Vector2d shift = gain_along(covariance_.topLeftCorner<2, 2>(), direction_I, variance) * off_m;
  covariance_ = corrected_along(covariance_, direction_I, variance);
  for (TrackedPose& pose : window_) pose.X_IR.t.head<2>() += shift;
  anchor_X_IR_.t.head<2>() += shift;
}

std::vector<TrackedPose> PlanTracker::update(const LocalizationScan& scan,
                                             const std::vector<PlaneObservation>& planes) {
  window_.push_back(associate(scan, planes, pose(scan.X_OR)));
  std::vector<TrackedPose> left;
  while (static_cast<int>(window_.size()) > config_.window) {
    left.push_back(window_.front());
    range_bias_.add(window_.front(), storey_, 1.0 / config_.window, config_);
    carry_anchor_covariance(window_[0], window_[1]);
    window_.pop_front();
    anchor_X_IR_ = window_.front().X_IR;
  }
  optimise();
  measure_walls();
  return left;
}

std::optional<TrackedPose> PlanTracker::update_standing(const LocalizationScan& scan,
                                                        const std::vector<PlaneObservation>& planes) {
  TrackedPose newest = associate(scan, planes, pose(scan.X_OR));
  std::optional<TrackedPose> replaced;
  if (window_.back().waited_s > 0.0) {
    replaced = std::move(window_.back());
    window_.pop_back();
  }
  newest.waited_s = seconds(scan.stamp - window_.back().stamp);
  window_.push_back(std::move(newest));
  optimise();
  covariance_ = covariance_of_newest(seen_walls(window_, storey_, range_bias_m_, config_));
  return replaced;
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
  // Of what may be the floor, what lies nearest to where it is expected: a bench may hold more returns.
  double least = config_.floor_gate_m;
  for (const PlaneObservation& level : level_planes_below(scan, planes, config_)) {
    const Plane floor_I = nearest_floor(storey_, level, X_IR, standing_m_, config_);
    const double off = std::abs(plane_residual(X_IR, floor_I, level.plane_R).e[2]);
    if (off > least) continue;
    least = off;
    pose.floor.assign(1, level);
    pose.floor_I = floor_I;
  }
  return pose;
}

void PlanTracker::optimise() {
  Vector6d hold;
  hold << config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_m, config_.anchor_sigma_rad,
      config_.anchor_sigma_rad, config_.anchor_sigma_rad;
  for (int k = 0; k < config_.iterations; ++k) {
    weigh_walls();
    WindowProblem problem(window_.size());
    problem.add_bias_prior(range_bias_m_ - range_bias_.mean(), std::sqrt(range_bias_.variance()));
    const PoseResidual held = pose_residual(anchor_X_IR_, window_.front().X_IR, Pose{});
    Matrix6d unheld = Matrix6d::Identity();
    unheld.topLeftCorner<2, 2>() =
        config_.anchor_sigma_m * inverse_root(anchor_covariance_) * anchor_X_IR_.rotation().topLeftCorner<2, 2>();
    problem.add(0, unheld * held.J_j, unheld * held.e, hold, 0.0);
    for (std::size_t i = 0; i < window_.size(); ++i) {
      add_planes(problem, i, window_[i], storey_, range_bias_m_, config_);
      if (config_.room_factor) add_rooms(problem, i, window_[i], storey_, config_);
      add_ground(problem, i, window_[i], storey_, standing_m_, config_);
      if (i + 1 == window_.size()) continue;
      const Pose X_ij = window_[i].X_OR.inverse() * window_[i + 1].X_OR;
      problem.add_between(i, pose_residual(window_[i].X_IR, window_[i + 1].X_IR, X_ij),
                          odometry_sigmas(X_ij, window_[i + 1].waited_s, config_));
    }
    const Eigen::VectorXd step = problem.solve();
    for (std::size_t i = 0; i < window_.size(); ++i)
      window_[i].X_IR = increment(window_[i].X_IR, step.segment<6>(6 * static_cast<Eigen::Index>(i)));
    range_bias_m_ += step[step.size() - 1];
  }
}

void PlanTracker::measure_walls() {
  const std::vector<SeenWall> walls = seen_walls(window_, storey_, range_bias_m_, config_);
  wall_tolerances_.add(walls, {range_bias_.mean(), range_bias_.variance(), range_bias_m_}, config_);
  covariance_ = covariance_of_newest(walls);
}

void PlanTracker::weigh_walls() {
  for (TrackedPose& pose : window_)
    for (WallLink& link : pose.walls)
      link.weight = wall_weight(pose, link, storey_, range_bias_m_, covariance_.topLeftCorner<2, 2>(), config_);
}

Eigen::Matrix3d PlanTracker::covariance_of_newest(const std::vector<SeenWall>& walls) const {
  Eigen::Matrix4d known = Eigen::Matrix4d::Zero();
  known.topLeftCorner<2, 2>() = anchor_covariance_.inverse();
  known(2, 2) = 1.0 / (config_.anchor_sigma_rad * config_.anchor_sigma_rad);
  known(3, 3) = 1.0 / range_bias_.variance();
  // Over all tolerances, since few walls tell which it is.
  const auto probabilities = wall_tolerances_.probabilities();
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int i = 0; i < WallTolerances::count; ++i) {
    const Eigen::Matrix4d information = known + wall_information(walls, wall_tolerances_.tolerance(i), config_);
    P += probabilities[static_cast<std::size_t>(i)] * information.inverse().topLeftCorner<3, 3>();
  }
  P.topLeftCorner<2, 2>() += config_.position_sigma_min_m * config_.position_sigma_min_m * Eigen::Matrix2d::Identity();
  P(2, 2) += config_.yaw_sigma_min * config_.yaw_sigma_min;
  return 0.5 * (P + P.transpose());
}

}  // namespace plumbline::slam
