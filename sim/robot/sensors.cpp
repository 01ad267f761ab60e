// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/sensors.h"

#include <Eigen/LU>
#include <cmath>

#include "sim/robot/types/kinematics.h"

namespace plumbline::sim {

namespace {

constexpr double step_s = 1e-9 * static_cast<double>(Robot::step_ns);

Eigen::Vector3d gauss3(const Stream& stream, std::uint64_t tick) {
  return {stream.gauss(tick, 0), stream.gauss(tick, 1), stream.gauss(tick, 2)};
}

/// Joint rates that move a foot at v_R, damped where the leg is nearly straight.
Eigen::Vector3d joint_rates(const Eigen::Matrix3d& jacobian, const Eigen::Vector3d& v_R) {
  constexpr double damping = 1e-4;  // m^2
  const Eigen::Matrix3d square = jacobian * jacobian.transpose() + damping * Eigen::Matrix3d::Identity();
  return jacobian.transpose() * (square.inverse() * v_R);
}

}  // namespace

ProprioceptionNoise noise_of(OdometryPreset preset) {
  ProprioceptionNoise noise;
  if (preset != OdometryPreset::ideal) return noise;
  noise.encoder = noise.joint_velocity = noise.gyro = noise.gyro_bias = noise.gyro_bias_walk = 0.0;
  noise.accelerometer = noise.contact_flip = noise.leg_scale = 0.0;
  return noise;
}

ProprioceptiveSensors::ProprioceptiveSensors(OdometryPreset preset, Seed seed, const ImuError& imu,
                                             const SlipConfig& slip)
    : noise_(noise_of(preset)),
      imu_(draw(imu, seed.run)),
      slips_(slip, step_s, seed),
      encoder_(seed, "sim.odometry.encoder"),
      velocity_(seed, "sim.odometry.velocity"),
      gyro_(seed, "sim.imu.gyro"),
      bias_(seed.run, "sim.imu.bias"),
      accelerometer_(seed, "sim.imu.accelerometer"),
      contact_(seed, "sim.odometry.contact"),
      gyro_bias_R_(noise_.gyro_bias * gauss3(bias_, 0)) {}

SensorReading ProprioceptiveSensors::read(const Proprioception& truth, std::int64_t tick_signed) {
  const auto tick = static_cast<std::uint64_t>(tick_signed);
  SensorReading out;
  for (std::size_t i = 0; i < out.q.size(); ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    out.q[i] = truth.q[i] + noise_.encoder * encoder_.gauss(tick, lane);
    out.qd[i] = truth.qd[i] + noise_.joint_velocity * velocity_.gauss(tick, lane);
  }
  for (std::size_t leg = 0; leg < out.contact.size(); ++leg) {
    const bool flipped = contact_.uniform(tick, static_cast<std::uint32_t>(leg)) < noise_.contact_flip;
    out.contact[leg] = (truth.touch[leg] > noise_.contact_force_n) != flipped;
  }
  gyro_bias_R_ += noise_.gyro_bias_walk * std::sqrt(step_s) * gauss3(bias_, tick + 1);
  const Eigen::Vector3d rate_R = imu_ ? imu_->gyro_R(truth.gyro_R) : truth.gyro_R;
  const Eigen::Vector3d force_R = imu_ ? imu_->accelerometer_R(truth.accelerometer_R) : truth.accelerometer_R;
  out.gyro_R = rate_R + gyro_bias_R_ + noise_.gyro * gauss3(gyro_, tick);
  out.accelerometer_R = force_R + noise_.accelerometer * gauss3(accelerometer_, tick);
  slide(truth, tick_signed, out);
  return out;
}

/// A foot that slides moves at the slip's velocity besides its motion against the base: its joints turn accordingly.
void ProprioceptiveSensors::slide(const Proprioception& truth, std::int64_t tick, SensorReading& reading) const {
  const Eigen::Vector3d slip_R = slips_.velocity_R(tick);
  if (slip_R.isZero(0.0)) return;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    if (truth.touch[leg] <= noise_.contact_force_n) continue;
    const LegAngles q(truth.q[3 * leg], truth.q[3 * leg + 1], truth.q[3 * leg + 2]);
    const Eigen::Vector3d rates = joint_rates(foot_jacobian_R(leg, q), slip_R);
    for (std::size_t joint = 0; joint < 3; ++joint)
      reading.qd[3 * leg + joint] += rates(static_cast<Eigen::Index>(joint));
  }
}

}  // namespace plumbline::sim
