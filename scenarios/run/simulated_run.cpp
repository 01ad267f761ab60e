// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/simulated_run.h"

#include <cmath>

namespace plumbline::scenarios {

SimulatedRun::SimulatedRun(const ResolvedScenario& resolved) : resolved_(resolved) {
  world_.emplace(resolved.world, resolved.building->as_built(), resolved.building->mesh_as_built());
}

bool SimulatedRun::next(sim::WorldFrame& frame) {
  if (world_->next(frame)) {
    if (begin_) carry_on(frame);
    last_stamp_ = frame.sensors.scan.stamp;
    if (!frame.sensors.odometry.empty()) last_X_OR_ = frame.sensors.odometry.back().X_OR;
    return true;
  }
  if (begin_ || last_stamp_ == 0 || !resolved_.world_after) return false;
  set_down();
  return next(frame);
}

void SimulatedRun::set_down() {
  constexpr slam::Nanoseconds ms = 1'000'000;
  const double away_s = resolved_.scenario.kidnap->away_s;
  begin_ = (last_stamp_ / ms + 1 + std::llround(1e3 * away_s)) * ms;
  X_OO_ = Pose::from_xyz_yaw(last_X_OR_.t, last_X_OR_.yaw());
  sim::WorldConfig after = *resolved_.world_after;
  ++after.part;
  after.duration_s -= slam::seconds(*begin_);
  after.lidar.running_s += slam::seconds(*begin_);
  world_.emplace(after, resolved_.building->as_built(), resolved_.building->mesh_as_built());
}

void SimulatedRun::carry_on(sim::WorldFrame& frame) const {
  slam::SensorFrame& sensors = frame.sensors;
  for (slam::Imu& imu : sensors.imu) imu.stamp += *begin_;
  for (slam::Odometry& odometry : sensors.odometry) {
    odometry.stamp += *begin_;
    odometry.X_OR = X_OO_ * odometry.X_OR;
  }
  for (slam::OdometryCovariance& covariance : sensors.covariances) covariance.stamp += *begin_;
  for (slam::Vlp16Packet& packet : sensors.packets) set_time(packet, packet.stamp + *begin_);
  for (sim::TruePose& truth : frame.truth.poses) truth.stamp += *begin_;
  sensors.scan.stamp += *begin_;
}

}  // namespace plumbline::scenarios
