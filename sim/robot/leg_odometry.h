// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "bim/geometry/pose.h"
#include "sim/robot/sensors.h"

namespace plumbline::sim {

/// [facts: legged section 10], but for the height: see LegOdometry.
struct LegOdometryConfig {
  double tilt_time_constant_s = 4.0;     ///< accelerometer into roll and pitch
  double gravity = 9.81;                 ///< m/s^2
  double contact_min_s = 0.020;          ///< a foot counts once it has stood so long
  double height_time_constant_s = 0.05;  ///< height of the stance feet into z
  double level_step_m = 0.04;            ///< footholds that differ by less lie on the same floor
  double leg_scale = 1.0;                ///< calibrated over true length of the legs
  bool rolling = true;                   ///< feet are spheres that roll: without this odometry is 6.5 % short
};

/// The preset's odometry; the seed draws the calibration error of the legs.
[[nodiscard]] LegOdometryConfig leg_odometry_config(OdometryPreset preset, std::uint64_t seed);

/// Dead reckoning from readings alone: X_OR, starting at identity. Roll and pitch lean on gravity, yaw is the
/// integrated gyro. Height comes from the feet that stand, not from integrated velocities, whose touchdown samples
/// climb by 1.8 % of the way: footholds closer in height than level_step_m are one floor, so steps are seen and
/// gentle ramps are not.
class LegOdometry {
 public:
  explicit LegOdometry(const LegOdometryConfig& config) : config_(config) {}

  /// Advances by one reading, taken dt seconds after the one before.
  void update(const SensorReading& reading, double dt);
  [[nodiscard]] const Pose& X_OR() const { return X_OR_; }

 private:
  struct Foot {
    double contact_s = 0.0;  ///< without a break so far
    bool stands = false;     ///< long enough to be trusted
    bool landed = false;     ///< trusted since this reading
    double level_O = 0.0;    ///< height of the floor it stands on or stood on last
  };

  void update_attitude(const SensorReading& reading, double dt);
  void update_contacts(const SensorReading& reading, double dt);
  void update_velocity(const SensorReading& reading);
  void update_height(const SensorReading& reading, double dt);
  [[nodiscard]] double sole_below_base(const SensorReading& reading, std::size_t leg) const;
  [[nodiscard]] double nearest_level(double height_O) const;

  LegOdometryConfig config_;
  Pose X_OR_;
  Eigen::Vector3d v_R_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_R_before_ = Eigen::Vector3d::Zero();
  std::array<Foot, 4> feet_{};
  bool started_ = false;
};

}  // namespace plumbline::sim
