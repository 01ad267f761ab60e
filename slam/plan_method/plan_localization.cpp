// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/plan_localization.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "bim/geometry/best_rotation.h"
#include "slam/planes/level.h"
#include "slam/planes/observe.h"

namespace plumbline::slam {

namespace {

const bim::Plan& plan_for(std::string_view name, const MethodInput& input) {
  if (!input.plan) throw InputError({}, std::string(name) + " needs a plan; give a plan or an IFC file");
  return *input.plan;
}

/// (x, y, yaw) covariance turned about z.
Eigen::Matrix3d turned(const Eigen::Matrix3d& P, const Pose& X_WI) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = heading(X_WI).rotation();
  return R * P * R.transpose();
}

}  // namespace

void record_stage(std::string_view stage, Stopwatch& stopwatch, Output& output) {
  output.times.push_back({std::string(stage), stopwatch.cpu_ms()});
  stopwatch.restart();
}

PlanLocalization::PlanLocalization(std::string_view name, const MethodInput& input, const PlanMethodConfig& config,
                                   const MapCloudConfig& map)
    : input_(input),
      config_(config),
      index_(make_plan_index(plan_for(name, input), input.prior.storey, config.index)),
      clock_offset_(input.calibration),
      map_config_(map),
      cloud_(map) {
  LidarOdometryConfig odometry;
  if (input.has_odometry) {
    if (config.scan_times) time_trial_.emplace(odometry, input.calibration, true);
    if (config.watch_odometry) watched_.emplace(input.calibration);
    return;
  }
  odometry.vgicp.odometry_prior = odometry.vgicp.tilt_prior = false;
  lidar_odometry_.emplace(odometry, input.calibration, false);
}

void PlanLocalization::on_odometry(const Odometry& odometry) {
  motion_.add(odometry);
  if (config_.scan_times) clock_offset_.add(odometry);
  if (time_trial_) time_trial_->on_odometry(odometry);
}

Output PlanLocalization::on_scan(const Scan& raw) {
  const std::optional<Scan> timed = sweep_times_.are_inferred() ? sweep_times_.with_times(raw) : std::nullopt;
  const Scan& scan = timed ? *timed : raw;
  Output output;
  output.stamp = scan.stamp;
  Stopwatch stopwatch;
  std::optional<DeskewedScan> tracked;
  const double silence_s = silence_before(scan);
  last_scan_ = scan.stamp;
  if (!start_s_) start_s_ = std::floor(seconds(scan.stamp));  // no odd share of a second, so that little depends on it
  const Pose X_OR = lidar_odometry_ ? track(scan, tracked.emplace()) : follow(scan, tracked);
  if (!X_OR_start_) X_OR_start_ = X_OR;
  const bool began_anew = !is_way_known_ && start_anew();
  if (began_anew) {
    X_OR_update_.reset();
    is_start_known_ = false;
  } else if (silence_s > 0.0 || is_due(X_OR)) {
    ++tick_;
    const PlanScan prepared_scan = prepare_scan(tracked ? std::move(*tracked) : deskewed(scan), X_OR, silence_s);
    if (cloud_.add(prepared_scan.deskewed, X_OR)) cloud_stamps_.push_back(scan.stamp);
    record_stage("deskew", stopwatch, output);
    use_scan(prepared_scan, output);
    X_OR_update_ = X_OR;
    used_ = scan.stamp;
  } else if (is_due_standing(scan.stamp)) {
    const PlanScan prepared_scan = prepare_scan(tracked ? std::move(*tracked) : deskewed(scan), X_OR, 0.0);
    record_stage("deskew", stopwatch, output);
    use_standing_scan(prepared_scan, output);
    used_ = scan.stamp;
  }
  report(X_OR, output);
  Digest digest;
  for (const Hypothesis& hypothesis : output.hypotheses) digest.add(hypothesis.mass).add(hypothesis.X_WR);
  output.digests.push_back({"pose", digest.add(static_cast<int>(output.state)).value()});
  trajectory_.add_scan(scan.stamp, X_OR);
  if (!lidar_odometry_) {
    motion_.forget_before(scan.stamp - 1'000'000'000);
    if (config_.scan_times && !(watched_ && watched_->is_by_scans())) test_times(scan, X_OR);
    if (time_trial_) try_times(raw);
  }
  return output;
}

int PlanLocalization::storey_of_plan(int plan_storey) {
  for (std::size_t i = 0; i < index_.storeys.size(); ++i)
    if (index_.storeys[i].plan_storey == plan_storey) return static_cast<int>(i);
  return add_storey(index_, *input_.plan, plan_storey);
}

bool PlanLocalization::is_due(const Pose& X_OR) const {
  if (!X_OR_update_) return true;
  const Pose2 u = heading(X_OR_update_->inverse() * X_OR);
  return u.t.norm() >= config_.update_m || std::abs(u.yaw) >= config_.update_rad;
}

bool PlanLocalization::is_due_standing(Nanoseconds stamp) const {
  return config_.standing_update_s > 0.0 && follows_standing() && seconds(stamp - used_) >= config_.standing_update_s;
}

double PlanLocalization::silence_before(const Scan& scan) const {
  constexpr Nanoseconds least = 500'000'000;  // in which nobody lifts a robot and sets it down again
  const Nanoseconds gap = last_scan_ ? motion_.longest_gap(*last_scan_, scan.stamp) : 0;
  return gap > std::max(least, motion_.max_age()) ? seconds(gap) : 0.0;
}

Pose PlanLocalization::track(const Scan& raw, DeskewedScan& scan) {
  scan = lidar_odometry_->deskewed(raw);
  std::optional<Eigen::Vector3d> up_R;
  if (!q_OM_) up_R = up_by_planes(observe_planes(scan, {}, RinglessRansacConfig(), input_.seed));
  const Registration odometry = lidar_odometry_->track(raw, scan);
  if (up_R) q_OM_ = rotation_between(odometry.X_MR.q * *up_R, Eigen::Vector3d::UnitZ());
  is_way_known_ = !odometry.lost && !odometry.displaced;
  if (!is_way_known_) step_changes_.interrupt();
  step_changes_.add(odometry.X_MR);
  // Localization starts anew: what matters is whether the way from here on is known.
  if (!odometry.lost && odometry.displaced) lidar_odometry_->locate_map();
  return Pose{q_OM_.value_or(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero()} * odometry.X_MR;
}

Pose PlanLocalization::follow(const Scan& raw, std::optional<DeskewedScan>& scan) {
  if (!watched_) return motion_.at(raw.stamp);
  WatchedOdometry::Tracked tracked = watched_->track(raw, motion_, undone_offset_);
  is_way_known_ = tracked.is_way_known;
  scan = std::move(tracked.deskewed);
  if (!scan)
    step_changes_ = {};
  else if (!is_way_known_)
    step_changes_.interrupt();
  else
    step_changes_.add(tracked.X_OR);
  return tracked.X_OR;
}

DeskewedScan PlanLocalization::deskewed(const Scan& scan) const {
  if (!compensation_.compensated()) return deskew(scan, motion_, input_.calibration);
  DeskewedScan out = as_deskewed(scan, input_.calibration);
  out.odometry_stale = motion_.is_stale_at(scan.stamp);
  out.odometry_age = motion_.age_at(scan.stamp);
  return out;
}

void PlanLocalization::try_times(const Scan& scan) {
  if (!has_times(scan)) {
    DeskewedScan deskewed = time_trial_->deskewed(scan);
    (void)time_trial_->track(scan, deskewed);
    sweep_times_ = time_trial_->sweep_times();
    if (!sweep_times_.is_settled()) return;
  }
  time_trial_.reset();
}

void PlanLocalization::test_times(const Scan& scan, const Pose& X_OR) {
  constexpr Nanoseconds sweep = 100'000'000;
  if (!sweep_times_.are_inferred() && !compensation_.compensated() && !compensation_.is_settled()) {
    const Eigen::Vector3d way_R = (motion_.at(scan.stamp - sweep).inverse() * X_OR).t;
    compensation_.add(scan, input_.calibration.X_RL.q.conjugate() * way_R / seconds(sweep));
  }
  clock_offset_.add(scan);
  if (undone_offset_ > 0) extrapolation_.add(scan.stamp, X_OR, motion_);
  // Returns of compensated scans are of the stamp, not of their own times.
  const Nanoseconds offset = compensation_.compensated() ? 0 : clock_offset_.value();
  if (offset == undone_offset_) return;
  undone_offset_ = offset;
  motion_.set_clock_offset(offset, scan.stamp);
  if (offset > 0)
    extrapolation_.interrupt();
  else
    extrapolation_ = {};  // nothing is carried on
}

PlanScan PlanLocalization::prepare_scan(DeskewedScan scan, const Pose& X_OR, double silence_s) const {
  PlanScan out;
  out.deskewed = std::move(scan);
  out.X_OR = X_OR;
  if (X_OR_update_) out.u = heading(*X_OR_update_).inverse() * heading(X_OR);
  out.q_HR = exp_so3({0.0, 0.0, -X_OR.yaw()}) * X_OR.q;
  out.tilt_sigma = step_changes_.tilt_sigma();
  if (input_.prior.yaw_W && is_start_known_) {
    // Rounded, so that a plan moved as a whole gives the same numbers.
    const double yaw_I = std::round((*input_.prior.yaw_W - index_.X_WI.yaw()) * 1e9) * 1e-9;
    out.prior_yaw_I = wrap_angle(yaw_I + X_OR.yaw() - X_OR_start_->yaw());
    out.prior_yaw_sigma =
        input_.prior.yaw_sigma + config_.yaw_drift * (seconds(out.deskewed.stamp) - start_s_.value_or(0.0));
  }
  out.tick = tick_;
  out.silence_s = silence_s;
  return out;
}

Pose PlanLocalization::pose_on_floor(int storey, const Pose2& X_IH, const Eigen::Quaterniond& q_HR,
                                     double sensor_height_m) const {
  const double sensor_z = index_.storeys[static_cast<std::size_t>(storey)].floor_at(X_IH.t) + sensor_height_m;
  const double z = sensor_z - (q_HR * input_.calibration.X_RL.t).z();
  return Pose::from_xyz_yaw({X_IH.t.x(), X_IH.t.y(), z}, X_IH.yaw) * Pose{q_HR, Eigen::Vector3d::Zero()};
}

Hypothesis PlanLocalization::hypothesis_in_W(double mass, int storey, const Pose& X_IR,
                                             const Eigen::Matrix3d& covariance) const {
  const StoreyIndex& there = index_.storeys[static_cast<std::size_t>(storey)];
  const int room = there.room_at(X_IR.t.head<2>());
  return {mass, index_.X_WI * X_IR, turned(covariance, index_.X_WI),
          room < 0 ? "" : there.rooms[static_cast<std::size_t>(room)].name};
}

void PlanLocalization::report_particles(const ParticleSet& particles, const Pose2& u, Output& output) const {
  const std::size_t most = static_cast<std::size_t>(config_.particles_shown);
  const std::size_t stride = std::max<std::size_t>(1, (particles.size() + most - 1) / most);
  const Pose2 X_WI = heading(index_.X_WI);
  for (std::size_t i = 0; i < particles.size(); i += stride) {
    const Pose2 X_WH = X_WI * (particles[i].X_IH * u);
    output.particles.push_back({X_WH.t.x(), X_WH.t.y(), X_WH.yaw, particles[i].weight});
  }
}

Estimate PlanLocalization::finish() {
  Estimate estimate;
  estimate.frame = Frame::world;
  if (trajectory_.empty()) return estimate;
  estimate.trajectory = trajectory_.poses(index_.X_WI);
  std::vector<CloudKeyframe> keyframes(cloud_.keyframes().begin(), cloud_.keyframes().end());
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    keyframes[i].X_FR =
        index_.X_WI * (trajectory_.correction_at(cloud_stamps_[i], keyframes[i].X_FR) * keyframes[i].X_FR);
  estimate.map_F = map_cloud(keyframes, map_config_);
  return estimate;
}

}  // namespace plumbline::slam
