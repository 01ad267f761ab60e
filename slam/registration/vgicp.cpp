// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/vgicp.h"

#include <optional>
#include <utility>

namespace plumbline::slam {

VgicpOdometry::VgicpOdometry(const VgicpConfig& config)
    : config_(config), map_(config.map_voxel_m), edge_map_(config.edges) {}

Registration VgicpOdometry::update(const DeskewedScan& scan, const Pose& X_OR) {
  Registration result = match(scan, {X_OR});
  commit(result.X_MR, true);
  return result;
}

Registration VgicpOdometry::match(const DeskewedScan& scan, const OdometrySample& odometry) {
  scan_ = make_surfels(scan, config_.surfels);
  edges_R_ = edge_points(scan, config_.edges);
  Registration result;
  result.X_MR = X_MR_;
  if (ready()) {
    const PosePrior prediction = predict(scan, odometry);
    const bool any = config_.odometry_prior || config_.tilt_prior;
    const std::optional<PosePrior> prior = any ? std::optional(prediction) : std::nullopt;
    // Lines are searched at the pose predicted by odometry: its error is below the spacing of columns.
    const std::vector<loam::Match> lines = edge_map_.match(edges_R_, prediction.X_MR);
    const double information = 1.0 / (config_.edges.sigma_m * config_.edges.sigma_m);
    result = align(scan_, map_, prediction.X_MR, prior, config_.registration, [&](const Pose& X_MR) {
      Normal6 terms = loam::linearize(lines, X_MR, config_.edges.huber_m);
      terms.h *= information;
      terms.g *= information;
      return terms;
    });
  }
  X_OR_ = odometry.X_OR;
  if (!q_OM_) q_OM_ = odometry.X_OR.q;
  return result;
}

void VgicpOdometry::commit(const Pose& X_MR, bool mapped) {
  X_MR_ = X_MR;
  is_keyframe_ = mapped && !scan_.empty();
  if (is_keyframe_ && ready()) {
    const Pose X_KR = keyframes_.back().X_MR.inverse() * X_MR;
    is_keyframe_ = X_KR.t.norm() >= config_.keyframe_distance_m || log_so3(X_KR.q).norm() >= config_.keyframe_angle_rad;
  }
  if (is_keyframe_) insert(X_MR_);
}

void VgicpOdometry::reset_map() {
  map_ = SurfelMap(config_.map_voxel_m);
  edge_map_ = EdgeMap(config_.edges);
  keyframes_.clear();
}

PosePrior VgicpOdometry::predict(const DeskewedScan& scan, const OdometrySample& odometry) const {
  const Pose step = X_OR_.inverse() * odometry.X_OR;
  PosePrior prior{X_MR_ * step, Matrix6d::Zero(), std::nullopt};
  if (config_.odometry_prior && odometry.valid) {
    const double sigma_m = config_.prior_m + config_.prior_per_m * step.t.norm();
    const double sigma_rad = config_.prior_rad + config_.prior_per_rad * log_so3(step.q).norm();
    prior.information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
    prior.information.diagonal().tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  }
  if (config_.tilt_prior && !scan.odometry_stale && q_OM_) {
    const Eigen::Vector3d up_O = Eigen::Vector3d::UnitZ();
    prior.tilt = TiltPrior{odometry.X_OR.q.conjugate() * up_O, q_OM_->conjugate() * up_O, config_.tilt_rad};
  }
  return prior;
}

void VgicpOdometry::insert(const Pose& X_MR) {
  map_.add(scan_, X_MR);
  edge_map_.add(std::move(edges_R_), X_MR, static_cast<std::size_t>(config_.map_keyframes));
  keyframes_.push_back({std::move(scan_), X_MR});
  if (keyframes_.size() <= static_cast<std::size_t>(config_.map_keyframes)) return;
  map_.remove(keyframes_.front().surfels, keyframes_.front().X_MR);
  keyframes_.pop_front();
}

}  // namespace plumbline::slam
