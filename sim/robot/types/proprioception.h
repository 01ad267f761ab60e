// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace plumbline::sim {

/// What the joints, the IMU and the feet truly did at one physics step; sensors add their noise to it. Forces (touch,
/// accelerometer) are those that led to the state, so they are of its step's beginning, 2 ms earlier.
struct Proprioception {
  std::array<double, 12> q{};                                 ///< joint angles, rad: per leg FL, FR, HL, HR: hx, hy, kn
  std::array<double, 12> qd{};                                ///< rad/s
  std::array<double, 4> touch{};                              ///< foot normal force, N
  Eigen::Vector3d gyro_R = Eigen::Vector3d::Zero();           ///< rad/s
  Eigen::Vector3d accelerometer_R = Eigen::Vector3d::Zero();  ///< m/s^2, includes -g
};

}  // namespace plumbline::sim
