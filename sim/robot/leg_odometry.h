// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "bim/geometry/pose.h"
#include "sim/robot/leg_covariance.h"
#include "sim/robot/leg_height.h"
#include "sim/robot/leg_slope.h"
#include "sim/robot/sensors.h"

namespace plumbline::sim {

/// Settings of the leg odometry, docs/methods/robot.md.
struct LegOdometryConfig {
  double tilt_time_constant_s = 4.0;   ///< accelerometer into roll and pitch
  double bias_time_constant_s = 16.0;  ///< roll and pitch into the gyro's bias; 4 tilt constants damp critically
  double gravity = 9.81;               ///< m/s^2
  double contact_min_s = 0.020;        ///< a foot counts once it has stood so long
  double leg_scale = 1.0;              ///< calibrated over true length of the legs
  bool rolling = true;                 ///< feet are spheres that roll: without this odometry is 6.5 % short
  LegHeightConfig height;
  LegSlopeConfig slope;
  LegCovarianceConfig covariance;
};

/// The preset's odometry; the seed draws the calibration error of the legs.
[[nodiscard]] LegOdometryConfig leg_odometry_config(OdometryPreset preset, std::uint64_t seed);

/// Dead reckoning from readings alone: X_OR, starting at identity. Gravity corrects roll and pitch, and the
/// corrections estimate the gyro's bias about the level axes; yaw is the integrated gyro. Height comes from the feet
/// that stand. Feet are spheres that roll on the ground's slope.
class LegOdometry {
 public:
  explicit LegOdometry(const LegOdometryConfig& config)
      : config_(config), height_(config.height), slope_(config.slope) {}

  /// Advances by one reading, taken dt seconds after the one before.
  void update(const SensorReading& reading, double dt);
  [[nodiscard]] const Pose& X_OR() const { return X_OR_; }
  /// Covariance of the motion since the last call: right increment (rho, phi) in R, m and rad. The readings' own are
  /// summed, as if R did not turn in between: right to a share of the angle turned.
  [[nodiscard]] Matrix6d take_covariance();

 private:
  void update_attitude(const SensorReading& reading, double dt);
  void update_contacts(const SensorReading& reading, double dt);
  void update_velocity(const SensorReading& reading);
  [[nodiscard]] bool stands(std::size_t leg) const { return contact_s_[leg] >= config_.contact_min_s; }
  /// Velocity of a standing foot's centre as it rolls, m/s in O.
  [[nodiscard]] Eigen::Vector3d rolling_O(const SensorReading& reading, std::size_t leg) const;
  void update_height(const SensorReading& reading, double dt);

  LegOdometryConfig config_;
  Pose X_OR_;
  Eigen::Vector3d v_R_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_R_before_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_R_ = Eigen::Vector3d::Zero();  ///< estimated, rad/s
  std::array<double, 4> contact_s_{};                      ///< without a break so far
  LegHeight height_;
  LegSlope slope_;
  Matrix6d covariance_ = Matrix6d::Zero();
};

}  // namespace plumbline::sim
