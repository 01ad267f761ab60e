// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "slam/odometry/lidar_odometry.h"

namespace plumbline::slam {

Matrix6d dead_reckoning_information(const LidarOdometryConfig& config, double way_m) {
  constexpr double least_step_m = 1e-3;  // standing still is not known for certain
  const double way = std::max(way_m, least_step_m);
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 /
                                               (config.dead_reckoning_sigma_m * config.dead_reckoning_sigma_m * way));
  information.diagonal().tail<3>().setConstant(
      1.0 / (config.dead_reckoning_sigma_rad * config.dead_reckoning_sigma_rad * way));
  return information;
}

Matrix6d unknown_information(const HealthConfig& limits, Nanoseconds dt, double speed_mps) {
  constexpr double least_dt_s = 0.01;
  const double dt_s = std::max(seconds(dt), least_dt_s);
  const double way_m = limits.max_deviation_m + speed_mps * dt_s + limits.max_acceleration_mps2 * dt_s * dt_s;
  const double turn_rad = limits.max_deviation_rad + limits.max_turn_acceleration_radps2 * dt_s * dt_s;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (way_m * way_m));
  information.diagonal().tail<3>().setConstant(1.0 / (turn_rad * turn_rad));
  return information;
}

}  // namespace plumbline::slam
