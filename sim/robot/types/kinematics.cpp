// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/types/kinematics.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline::sim {

namespace {

/// Limits that keep every inverse solution inside the joint ranges, rad, and the knee off its singularity.
constexpr double hx_max = 0.75;
constexpr double hy_min = -0.88;
constexpr double hy_max = 2.25;
constexpr double cos_knee_min = -0.93;
constexpr double cos_knee_max = 0.955;
constexpr double leg_depth2_min = 1e-4;  ///< m^2, of the foot below the hip in the leg plane

/// The foot in the leg plane before abduction: x forward, y sideways (constant), z up, m.
Eigen::Vector3d foot_in_leg_plane(std::size_t leg, const LegAngles& q) {
  const RobotDimensions& d = robot_dimensions;
  return {-d.thigh * std::sin(q[1]) - d.shank * std::sin(q[1] + q[2]), side_sign(leg) * d.abduction,
          -d.thigh * std::cos(q[1]) - d.shank * std::cos(q[1] + q[2])};
}

}  // namespace

Eigen::Vector3d hip_R(std::size_t leg) {
  return {front_sign(leg) * robot_dimensions.hip_x, side_sign(leg) * robot_dimensions.hip_y, 0.0};
}

Eigen::Vector3d foot_R(std::size_t leg, const LegAngles& q) {
  const Eigen::Vector3d p = foot_in_leg_plane(leg, q);
  const double s = std::sin(q[0]);
  const double c = std::cos(q[0]);
  return hip_R(leg) + Eigen::Vector3d(p.x(), p.y() * c - p.z() * s, p.y() * s + p.z() * c);
}

Eigen::Matrix3d foot_jacobian_R(std::size_t leg, const LegAngles& q) {
  const RobotDimensions& d = robot_dimensions;
  const Eigen::Vector3d p = foot_in_leg_plane(leg, q);
  const double s = std::sin(q[0]);
  const double c = std::cos(q[0]);
  const double b = -d.shank * std::cos(q[1] + q[2]);
  const double h = d.shank * std::sin(q[1] + q[2]);
  const double e = d.thigh * std::sin(q[1]) + h;
  Eigen::Matrix3d J;
  J << 0.0, p.z(), b,                          //
      -p.y() * s - p.z() * c, -e * s, -h * s,  //
      p.y() * c - p.z() * s, e * c, h * c;
  return J;
}

LegAngles leg_angles(std::size_t leg, const Eigen::Vector3d& p_R) {
  const RobotDimensions& d = robot_dimensions;
  const Eigen::Vector3d p = p_R - hip_R(leg);
  const double depth2 = p.y() * p.y() + p.z() * p.z() - d.abduction * d.abduction;
  const double z = -std::sqrt(std::max(leg_depth2_min, depth2));
  const double hx = wrap_angle(std::atan2(p.z(), p.y()) - std::atan2(z, side_sign(leg) * d.abduction));
  const double reach2 = p.x() * p.x() + z * z;
  const double cos_knee = (reach2 - d.thigh * d.thigh - d.shank * d.shank) / (2.0 * d.thigh * d.shank);
  const double kn = -std::acos(std::clamp(cos_knee, cos_knee_min, cos_knee_max));
  const double hy = std::atan2(-p.x(), -z) - std::atan2(d.shank * std::sin(kn), d.thigh + d.shank * std::cos(kn));
  return {std::clamp(hx, -hx_max, hx_max), std::clamp(hy, hy_min, hy_max), kn};
}

}  // namespace plumbline::sim
