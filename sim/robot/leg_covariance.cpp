// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_covariance.h"

#include "sim/robot/types/kinematics.h"

namespace plumbline::sim {

namespace {

double squared(double x) { return x * x; }

/// Variance densities of the base velocity's lasting errors, (m/s)^2.
Eigen::Matrix3d lasting(const LegCovarianceConfig& config, const SensorReading& reading,
                        const Eigen::Vector3d& mean_foot_R, const Eigen::Vector3d& v_R) {
  const Eigen::Matrix3d lever = hat(mean_foot_R);
  Eigen::Matrix3d out = squared(config.noise.leg_scale) * v_R * v_R.transpose();
  out += squared(config.noise.gyro_bias) * lever * lever.transpose();
  out += squared(config.slip) * v_R.squaredNorm() * Eigen::Matrix3d::Identity();
  out(1, 1) += squared(config.turn_slip_m * reading.gyro_R.z());
  return out;
}

}  // namespace

Matrix6d leg_increment_covariance(const LegCovarianceConfig& config, const SensorReading& reading,
                                  const std::array<bool, 4>& stands, const Eigen::Vector3d& v_R, double dt) {
  const ProprioceptionNoise& noise = config.noise;
  Eigen::Vector3d feet_R = Eigen::Vector3d::Zero();
  Eigen::Matrix3d white = Eigen::Matrix3d::Zero();  // (m/s)^2 a sample, summed over feet
  int count = 0;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    if (!stands[leg]) continue;
    const LegAngles q(reading.q[3 * leg], reading.q[3 * leg + 1], reading.q[3 * leg + 2]);
    const Eigen::Matrix3d jacobian = foot_jacobian_R(leg, q);
    white += squared(noise.joint_velocity) * jacobian * jacobian.transpose();
    feet_R += foot_R(leg, q);
    ++count;
  }
  Matrix6d out = Matrix6d::Zero();
  if (count > 0) {
    const Eigen::Matrix3d lever = hat(feet_R / count);
    white = white / squared(count) + squared(noise.gyro) * lever * lever.transpose();
    out.topLeftCorner<3, 3>() = white * dt * dt + lasting(config, reading, feet_R / count, v_R) * dt * config.horizon_s;
  } else {
    out.topLeftCorner<3, 3>() = squared(config.blind) * dt * Eigen::Matrix3d::Identity();
  }
  // Height comes from where the feet stand, not from the velocity.
  out.row(2).setZero();
  out.col(2).setZero();
  out(2, 2) = squared(config.creep) * dt;
  const double rotation = squared(noise.gyro * dt);
  out(3, 3) = out(4, 4) = rotation + squared(config.tilt) * dt;
  out(5, 5) = rotation + (squared(config.heading) + squared(noise.gyro_bias) * config.horizon_s) * dt;
  return out;
}

}  // namespace plumbline::sim
