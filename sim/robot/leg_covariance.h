// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "bim/geometry/pose.h"
#include "sim/robot/sensors.h"

namespace plumbline::sim {

/// Error model of the leg odometry: the noise of its sensors, and the errors that remain without noise, measured on
/// walks over flat floor.
struct LegCovarianceConfig {
  ProprioceptionNoise noise;
  double horizon_s = 1.0;      ///< errors that last (scale, bias) are counted as if drawn anew after so long
  double slip = 0.0015;        ///< of the speed, any direction
  double turn_slip_m = 0.009;  ///< sideways speed over yaw rate
  double creep = 1.3e-3;       ///< height, m per sqrt(s)
  double tilt = 0.45e-3;       ///< roll and pitch, rad per sqrt(s)
  double heading = 0.05e-3;    ///< rad per sqrt(s)
  double blind = 0.01;         ///< level, while no foot stands, m per sqrt(s)
};

/// Covariance of the right increment (rho, phi) in R, m and rad, of one reading dt seconds after the one before, with
/// the base at v_R. Increments compounded as if independent are consistent over about horizon_s: over less, jitter of
/// the gait (0.1 mm, 0.3 mrad) is missing, over more, scale and bias add up faster than modelled. The short
/// distances of an uncorrected odometry are not modelled.
[[nodiscard]] Matrix6d leg_increment_covariance(const LegCovarianceConfig& config, const SensorReading& reading,
                                                const std::array<bool, 4>& stands, const Eigen::Vector3d& v_R,
                                                double dt);

}  // namespace plumbline::sim
