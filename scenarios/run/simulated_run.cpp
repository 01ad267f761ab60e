// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/simulated_run.h"

#include <cmath>

namespace plumbline::scenarios {

Walk::Walk(const ResolvedScenario& resolved, const bim::BuildingMesh& mesh) : resolved_(resolved), mesh_(mesh) {
  world_.emplace(resolved.world, resolved.site.as_built, mesh);
}

bool Walk::next(sim::WorldFrame& frame) {
  if (world_->next(frame)) {
    if (begin_) carry_on(frame);
    last_stamp_ = frame.scan.stamp;
    if (!frame.odometry.empty()) last_X_OR_ = frame.odometry.back().X_OR;
    return true;
  }
  if (begin_ || last_stamp_ == 0 || !resolved_.world_after) return false;
  set_down();
  return next(frame);
}

void Walk::set_down() {
  constexpr slam::Nanoseconds ms = 1'000'000;
  const double away_s = resolved_.scenario.kidnap->away_s;
  begin_ = (last_stamp_ / ms + 1 + std::llround(1e3 * away_s)) * ms;
  X_OO_ = Pose::from_xyz_yaw(last_X_OR_.t, last_X_OR_.yaw());
  sim::WorldConfig after = *resolved_.world_after;
  after.duration_s -= slam::seconds(*begin_);
  world_.emplace(after, resolved_.site.as_built, mesh_);
}

void Walk::carry_on(sim::WorldFrame& frame) const {
  for (slam::Imu& imu : frame.imu) imu.stamp += *begin_;
  for (slam::Odometry& odometry : frame.odometry) {
    odometry.stamp += *begin_;
    odometry.X_OR = X_OO_ * odometry.X_OR;
  }
  for (slam::OdometryCovariance& covariance : frame.covariances) covariance.stamp += *begin_;
  for (slam::Vlp16Packet& packet : frame.packets) set_time(packet, packet.stamp + *begin_);
  for (sim::TruePose& truth : frame.truth) truth.stamp += *begin_;
  frame.scan.stamp += *begin_;
}

}  // namespace plumbline::scenarios
