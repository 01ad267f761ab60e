// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/sensors.h"

#include <cmath>

namespace plumbline::sim {

namespace {

constexpr double step_s = 1e-9 * static_cast<double>(Robot::step_ns);

Eigen::Vector3d gauss3(const Stream& stream, std::uint64_t tick) {
  return {stream.gauss(tick, 0), stream.gauss(tick, 1), stream.gauss(tick, 2)};
}

}  // namespace

ProprioceptionNoise noise_of(OdometryPreset preset) {
  ProprioceptionNoise noise;
  if (preset != OdometryPreset::ideal) return noise;
  noise.encoder = noise.joint_velocity = noise.gyro = noise.gyro_bias = noise.gyro_bias_walk = 0.0;
  noise.accelerometer = noise.contact_flip = noise.leg_scale = 0.0;
  return noise;
}

ProprioceptiveSensors::ProprioceptiveSensors(OdometryPreset preset, std::uint64_t seed)
    : noise_(noise_of(preset)),
      encoder_(seed, "sim.odometry.encoder"),
      velocity_(seed, "sim.odometry.velocity"),
      gyro_(seed, "sim.imu.gyro"),
      bias_(seed, "sim.imu.bias"),
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
  out.gyro_R = truth.gyro_R + gyro_bias_R_ + noise_.gyro * gauss3(gyro_, tick);
  out.accelerometer_R = truth.accelerometer_R + noise_.accelerometer * gauss3(accelerometer_, tick);
  return out;
}

}  // namespace plumbline::sim
