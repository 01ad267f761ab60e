// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/plan_baseline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bim/digest/digest.h"
#include "bim/errors.h"

namespace plumbline::slam {

namespace {

const bim::Plan& plan_for(std::string_view name, const MethodInput& input) {
  if (!input.plan) throw InputError({}, std::string(name) + " needs a plan; give a plan or an IFC file");
  if (!input.has_odometry) throw InputError({}, std::string(name) + " needs odometry, which there is none of");
  return *input.plan;
}

/// (x, y, yaw) covariance turned about z.
Eigen::Matrix3d turned(const Eigen::Matrix3d& P, const Pose& X_WI) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = heading(X_WI).rotation();
  return R * P * R.transpose();
}

}  // namespace

void note_stage(std::string_view stage, Stopwatch& watch, Output& output) {
  output.times.push_back({std::string(stage), watch.cpu_ms()});
  watch.restart();
}

PlanBaseline::PlanBaseline(std::string_view name, const MethodInput& input, const PlanBaselineConfig& config,
                           const MapCloudConfig& map)
    : input_(input),
      config_(config),
      index_(make_plan_index(plan_for(name, input), input.prior.storey, config.index)),
      map_config_(map),
      cloud_(map) {}

Output PlanBaseline::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  Stopwatch watch;
  const Pose X_OR = motion_.at(scan.stamp);
  if (!X_OR_start_) X_OR_start_ = X_OR;
  if (is_due(X_OR)) {
    ++tick_;
    const PlanScan prepared_scan = prepared(scan, X_OR);
    if (cloud_.add(prepared_scan.deskewed, X_OR)) cloud_stamps_.push_back(scan.stamp);
    note_stage("deskew", watch, output);
    belief_ = update(prepared_scan, output);
    X_OR_update_ = X_OR;
    if (belief_.X_IR) {
      X_IO_ = *belief_.X_IR * X_OR.inverse();
      trail_.add_correction(scan.stamp, *X_IO_);
    }
  }
  say_where(X_OR, output);
  for (PlanPlace& place : belief_.places) place.walls.clear();
  trail_.add_scan(scan.stamp, X_OR);
  motion_.forget_before(scan.stamp - 1'000'000'000);
  return output;
}

bool PlanBaseline::is_due(const Pose& X_OR) const {
  if (!X_OR_update_) return true;
  const Pose2 u = heading(X_OR_update_->inverse() * X_OR);
  return u.t.norm() >= config_.update_m || std::abs(u.yaw) >= config_.update_rad;
}

PlanScan PlanBaseline::prepared(const Scan& scan, const Pose& X_OR) const {
  PlanScan out;
  out.deskewed = deskew(scan, motion_, input_.calibration);
  out.X_OR = X_OR;
  if (X_OR_update_) out.u = heading(*X_OR_update_).inverse() * heading(X_OR);
  out.q_HR = exp_so3({0.0, 0.0, -X_OR.yaw()}) * X_OR.q;
  if (input_.prior.yaw_W) {
    // Rounded, so that a plan moved as a whole gives the same numbers.
    const double yaw_I = std::round((*input_.prior.yaw_W - index_.X_WI.yaw()) * 1e9) * 1e-9;
    out.told_yaw_I = wrap_angle(yaw_I + X_OR.yaw() - X_OR_start_->yaw());
    out.told_yaw_sigma = input_.prior.yaw_sigma + config_.yaw_drift * seconds(scan.stamp);
  }
  out.tick = tick_;
  return out;
}

Pose PlanBaseline::standing(int storey, const Pose2& X_IH, const Eigen::Quaterniond& q_HR) const {
  const double sensor_z = index_.storeys[static_cast<std::size_t>(storey)].floor_z + input_.calibration.sensor_height_m;
  const double z = sensor_z - (q_HR * input_.calibration.X_RL.t).z();
  return Pose::from_xyz_yaw({X_IH.t.x(), X_IH.t.y(), z}, X_IH.yaw) * Pose{q_HR, Eigen::Vector3d::Zero()};
}

void PlanBaseline::say_where(const Pose& X_OR, Output& output) const {
  output.state = belief_.state;
  if (X_IO_) output.X_FR = index_.X_WI * (*X_IO_ * X_OR);
  const Pose moved = X_OR_update_ ? X_OR_update_->inverse() * X_OR : Pose{};
  for (const PlanPlace& place : belief_.places) {
    if (place.mass < config_.mass_shown) continue;
    const StoreyIndex& storey = index_.storeys[static_cast<std::size_t>(place.storey)];
    const Pose X_IR = place.X_IR * moved;
    const int room = storey.room_at(X_IR.t.head<2>());
    output.hypotheses.push_back({place.mass, index_.X_WI * X_IR, turned(place.covariance, index_.X_WI),
                                 room < 0 ? "" : storey.rooms[static_cast<std::size_t>(room)].name, place.walls});
  }
  const std::size_t most = static_cast<std::size_t>(config_.particles_shown);
  const std::size_t stride = std::max<std::size_t>(1, (belief_.particles.size() + most - 1) / most);
  const Pose2 X_WI = heading(index_.X_WI), u = heading(moved);
  for (std::size_t i = 0; i < belief_.particles.size(); i += stride) {
    const Pose2 X_WH = X_WI * (belief_.particles[i].X_IH * u);
    output.particles.push_back({X_WH.t.x(), X_WH.t.y(), X_WH.yaw, belief_.particles[i].weight});
  }
  Digest digest;
  for (const Hypothesis& hypothesis : output.hypotheses) digest.add(hypothesis.mass).add(hypothesis.X_WR);
  output.digests.push_back({"pose", digest.add(static_cast<int>(belief_.state)).value()});
}

Estimate PlanBaseline::finish() {
  Estimate estimate;
  estimate.frame = Frame::world;
  if (trail_.empty()) return estimate;
  estimate.trajectory = trail_.poses(index_.X_WI);
  std::vector<CloudKeyframe> keyframes(cloud_.keyframes().begin(), cloud_.keyframes().end());
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    keyframes[i].X_FR = index_.X_WI * (trail_.correction_at(cloud_stamps_[i], keyframes[i].X_FR) * keyframes[i].X_FR);
  estimate.map_F = map_cloud(keyframes, map_config_);
  return estimate;
}

}  // namespace plumbline::slam
