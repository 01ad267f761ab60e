// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "bim/random/stream.h"
#include "sim/robot/imu_error.h"
#include "sim/robot/robot.h"
#include "sim/robot/slip.h"

namespace plumbline::sim {

/// ideal: no noise. noisy: all of it. uncorrected: noisy, and the odometry forgets that its feet roll.
enum class OdometryPreset { ideal, noisy, uncorrected };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(OdometryPreset) {
  return {"ideal", "noisy", "uncorrected"};
}

/// Errors of the robot's own sensors, standard deviations per 2 ms sample unless said, docs/methods/robot.md.
/// The two that govern drift (gyro bias, leg scale) are set so that a draw typically drifts by 0.3-1.5 % of the way and
/// 0.5-5 deg/min, as real legged robots do.
struct ProprioceptionNoise {
  double encoder = 0.5e-3;        ///< rad
  double joint_velocity = 0.02;   ///< rad/s
  double gyro = 3e-3;             ///< rad/s
  double gyro_bias = 0.8e-3;      ///< rad/s, drawn once per axis: 2.8 deg/min
  double gyro_bias_walk = 2e-5;   ///< rad/s per sqrt(s)
  double accelerometer = 0.05;    ///< m/s^2
  double contact_flip = 0.002;    ///< probability that a contact flag is wrong
  double leg_scale = 0.008;       ///< relative error of the legs' calibrated length, drawn once
  double contact_force_n = 25.0;  ///< N, touch force that sets the contact flag
};

[[nodiscard]] ProprioceptionNoise noise_of(OdometryPreset preset);

/// Encoders, gyro, accelerometer and contact flags of one physics step, as measured.
struct SensorReading {
  std::array<double, 12> q{};   ///< rad, as Proprioception::q
  std::array<double, 12> qd{};  ///< rad/s
  std::array<bool, 4> contact{};
  Eigen::Vector3d gyro_R = Eigen::Vector3d::Zero();           ///< rad/s
  Eigen::Vector3d accelerometer_R = Eigen::Vector3d::Zero();  ///< m/s^2, includes -g
};

/// Adds the preset's noise to the truth, and errors of the IMU and slipping feet where they are asked for.
class ProprioceptiveSensors {
 public:
  ProprioceptiveSensors(OdometryPreset preset, Seed seed, const ImuError& imu = {}, const SlipConfig& slip = {});

  /// tick counts physics steps and must grow by one from call to call, since the gyro's bias walks.
  [[nodiscard]] SensorReading read(const Proprioception& truth, std::int64_t tick);

 private:
  void slide(const Proprioception& truth, std::int64_t tick, SensorReading& reading) const;

  ProprioceptionNoise noise_;
  std::optional<ImuErrorDraw> imu_;
  Slips slips_;
  Stream encoder_, velocity_, gyro_, bias_, accelerometer_, contact_;
  Eigen::Vector3d gyro_bias_R_;
};

}  // namespace plumbline::sim
