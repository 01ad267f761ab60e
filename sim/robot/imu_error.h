// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace plumbline::sim {

/// How far an IMU is off since it was calibrated, on each axis with a sign of its own; docs/methods/robot.md.
struct ImuError {
  double gyro_bias = 0.0;           ///< rad/s
  double accelerometer_bias = 0.0;  ///< m/s^2
  double scale = 0.0;               ///< relative, of both
};

/// The error of one unit: a measured vector is scale * true + bias, axis by axis.
struct ImuErrorDraw {
  Eigen::Vector3d gyro_bias_R = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d accelerometer_bias_R = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_scale = Eigen::Vector3d::Ones();

  [[nodiscard]] Eigen::Vector3d gyro_R(const Eigen::Vector3d& true_R) const {
    return gyro_scale.cwiseProduct(true_R) + gyro_bias_R;
  }
  [[nodiscard]] Eigen::Vector3d accelerometer_R(const Eigen::Vector3d& true_R) const {
    return accelerometer_scale.cwiseProduct(true_R) + accelerometer_bias_R;
  }
};

/// Draws the signs. Nothing where there is no error.
[[nodiscard]] std::optional<ImuErrorDraw> draw(const ImuError& error, std::uint64_t seed);

}  // namespace plumbline::sim
