// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_odometry.h"

#include <cmath>
#include <utility>

#include "sim/robot/types/kinematics.h"

namespace plumbline::sim {

namespace {

Eigen::Vector3d leg_values(const std::array<double, 12>& values, std::size_t leg) {
  return {values[3 * leg], values[3 * leg + 1], values[3 * leg + 2]};
}

/// Centre of the foot by the calibrated leg, whose length may be wrong.
Eigen::Vector3d calibrated_foot_R(const SensorReading& reading, std::size_t leg, double scale) {
  const Eigen::Vector3d hip = hip_R(leg);
  return hip + scale * (foot_R(leg, leg_values(reading.q, leg)) - hip);
}

/// Angular velocity of the shank in R.
Eigen::Vector3d shank_rate_R(const SensorReading& reading, std::size_t leg) {
  const Eigen::Vector3d q = leg_values(reading.q, leg);
  const Eigen::Vector3d qd = leg_values(reading.qd, leg);
  const double swing = qd[1] + qd[2];
  return reading.gyro_R + Eigen::Vector3d(qd[0], std::cos(q[0]) * swing, std::sin(q[0]) * swing);
}

}  // namespace

LegOdometryConfig leg_odometry_config(OdometryPreset preset, std::uint64_t seed) {
  LegOdometryConfig config;
  config.leg_scale = 1.0 + noise_of(preset).leg_scale * Stream(seed, "sim.odometry.scale").gauss(0);
  config.covariance.noise = noise_of(preset);
  config.rolling = preset != OdometryPreset::uncorrected;
  return config;
}

void LegOdometry::update(const SensorReading& reading, double dt) {
  update_attitude(reading, dt);
  update_contacts(reading, dt);
  update_velocity(reading);
  X_OR_.t += X_OR_.q * v_R_ * dt;
  update_height(reading, dt);
  covariance_ +=
      leg_increment_covariance(config_.covariance, reading, {stands(0), stands(1), stands(2), stands(3)}, v_R_, dt);
}

Matrix6d LegOdometry::take_covariance() {
  Matrix6d out = std::exchange(covariance_, Matrix6d::Zero());
  out.triangularView<Eigen::StrictlyLower>() = out.transpose();  // sums of products differ in their last bits
  return out;
}

/// Gyro, pulled towards gravity in roll and pitch; yaw must not follow the accelerometer. The
/// acceleration measured by the legs is removed first: starts and curves would be taken for a tilt of degrees. The
/// difference of the last two velocities is noisy, but its sum over time is not.
void LegOdometry::update_attitude(const SensorReading& reading, double dt) {
  const Eigen::Vector3d up_R = X_OR_.q.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d own_R = (v_R_ - v_R_before_) / dt + reading.gyro_R.cross(v_R_);
  const Eigen::Vector3d gravity_R = reading.accelerometer_R - own_R;
  const Eigen::Vector3d tilt_R = gravity_R.cross(up_R) / config_.gravity;
  const Eigen::Vector3d correction_R = (tilt_R - tilt_R.dot(up_R) * up_R) / config_.tilt_time_constant_s;
  gyro_bias_R_ -= correction_R * dt / config_.bias_time_constant_s;
  X_OR_.q = (X_OR_.q * exp_so3((reading.gyro_R - gyro_bias_R_ + correction_R) * dt)).normalized();
}

void LegOdometry::update_contacts(const SensorReading& reading, double dt) {
  for (std::size_t leg = 0; leg < leg_count; ++leg) contact_s_[leg] = reading.contact[leg] ? contact_s_[leg] + dt : 0.0;
}

Eigen::Vector3d LegOdometry::rolling_O(const SensorReading& reading, std::size_t leg) const {
  if (!config_.rolling) return Eigen::Vector3d::Zero();
  return (X_OR_.q * shank_rate_R(reading, leg)).cross(robot_dimensions.foot_radius * slope_.normal_O());
}

/// Mean over the standing feet; a foot's centre moves as its sphere rolls on the ground. Kept while none stands.
void LegOdometry::update_velocity(const SensorReading& reading) {
  Eigen::Vector3d sum_R = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    if (!stands(leg)) continue;
    const Eigen::Vector3d foot_rate_R =
        config_.leg_scale * (foot_jacobian_R(leg, leg_values(reading.q, leg)) * leg_values(reading.qd, leg));
    Eigen::Vector3d v_R = -(reading.gyro_R.cross(calibrated_foot_R(reading, leg, config_.leg_scale)) + foot_rate_R);
    v_R += X_OR_.q.conjugate() * rolling_O(reading, leg);
    sum_R += v_R;
    ++count;
  }
  v_R_before_ = v_R_;
  if (count > 0) v_R_ = sum_R / count;
}

/// From the lowest points of the feet against the base, along z of O, and what those that stand climb as they roll.
void LegOdometry::update_height(const SensorReading& reading, double dt) {
  std::array<Eigen::Vector3d, leg_count> foot_O;
  std::array<double, leg_count> sole_m{}, climb{};
  std::array<bool, leg_count> standing{};
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector3d lever_O = X_OR_.q * calibrated_foot_R(reading, leg, config_.leg_scale);
    foot_O[leg] = X_OR_.t + lever_O;
    sole_m[leg] = lever_O.z() - robot_dimensions.foot_radius;
    climb[leg] = rolling_O(reading, leg).z();
    standing[leg] = stands(leg);
  }
  slope_.update(foot_O, standing, dt);
  height_.update(reading, X_OR_.q, sole_m, climb, dt);
  X_OR_.t.z() = height_.z();
}

}  // namespace plumbline::sim
