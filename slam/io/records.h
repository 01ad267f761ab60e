// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "bim/geometry/pose.h"

namespace plumbline::slam {

/// Integer time since the start of a recording, ns.
using Nanoseconds = std::int64_t;

[[nodiscard]] constexpr double seconds(Nanoseconds t) { return static_cast<double>(t) * 1e-9; }

/// Leg or wheel odometry: pose of the robot in the odometry frame O, which starts at the first pose. The covariance
/// travels separately, see odometry_covariance.h.
struct Odometry {
  Nanoseconds stamp = 0;
  Pose X_OR;
};

/// Inertial measurement in R.
struct Imu {
  Nanoseconds stamp = 0;
  Eigen::Vector3d angular_velocity_R = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d linear_acceleration_R =
      Eigen::Vector3d::Zero();  ///< specific force, m/s^2: (0, 0, 9.81) at rest and level
};

/// One spinning-LiDAR message: `columns` firings of `rings` lasers. Index of a return: column * rings + ring, ring 0
/// the lowest. A message is not exactly one turn (VLP-16: 1,824 columns, about 363 degrees).
struct Scan {
  Nanoseconds stamp = 0;  ///< time of the last return slot; the pose a method gives belongs to this time
  int rings = 16;
  int columns = 0;
  std::vector<double> range_m;           ///< 0: no return
  std::vector<Eigen::Vector3d> point_L;  ///< in L at the return's own firing time, zero where there is no return
  std::vector<float> reflectivity;       ///< 0-255
  std::vector<std::int32_t> offset_ns;   ///< time of the return relative to stamp, <= 0

  [[nodiscard]] std::size_t size() const { return range_m.size(); }
};

/// What a robot's owner measured once: where the sensor sits.
struct Calibration {
  Pose X_RL;
  double sensor_height_m = 0.66;  ///< m, of L above the floor when the robot stands
};

}  // namespace plumbline::slam
