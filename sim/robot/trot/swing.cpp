// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/swing.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

/// Smooth step from 0 to 1 with zero velocity and acceleration at both ends, and its derivative.
double smooth5(double x) { return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x); }
double smooth5_derivative(double x) { return 30.0 * x * x * (1.0 - x) * (1.0 - x); }

Eigen::Vector3d rotate_z(double angle, const Eigen::Vector3d& v) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()};
}

Eigen::Vector3d horizontal(const Eigen::Vector3d& v) { return {v.x(), v.y(), 0.0}; }

}  // namespace

Eigen::Vector3d foothold(const FootholdConfig& config, const Gait& gait, const BodyState& state,
                         const Reference& reference, const Terrain& terrain, std::size_t leg) {
  const RobotDimensions& d = robot_dimensions;
  const Eigen::Vector3d turn_W(0.0, 0.0, reference.yaw_rate());
  const double remaining_s = (1.0 - gait.swing_progress(leg)) * gait.swing_s();
  const double yaw = state.X_WR.yaw() + reference.yaw_rate() * remaining_s;
  const Eigen::Vector3d hip_W = rotate_z(yaw, hip_R(leg) + Eigen::Vector3d(0.0, side_sign(leg) * d.abduction, 0.0));

  const Eigen::Vector3d v_W = horizontal(state.v_W);
  const Eigen::Vector3d v_mean_W = 0.5 * (v_W + reference.v_W());
  const Eigen::Vector3d base_W = state.X_WR.t + v_mean_W * remaining_s + hip_W;
  Eigen::Vector3d offset_W = horizontal(
      0.5 * gait.stance_s() * v_mean_W + config.velocity_gain_s * (v_W - reference.v_W()) +
      config.pendulum_height_m / (2.0 * gravity) * v_W.cross(turn_W) + 0.5 * gait.stance_s() * turn_W.cross(hip_W));
  const double length = offset_W.norm();
  if (length > config.offset_max_m) offset_W *= config.offset_max_m / length;

  Eigen::Vector3d p_W = base_W + offset_W;
  p_W.z() = terrain(p_W.x(), p_W.y(), state.X_WR.t.z()) + d.foot_radius - config.below_ground_m;
  return p_W;
}

FootTarget swing_point(const SwingConfig& config, const Eigen::Vector3d& lift_off_W, const Eigen::Vector3d& target_W,
                       double progress, double swing_s) {
  const Eigen::Vector3d span_W = target_W - lift_off_W;
  FootTarget out;
  out.p_W = lift_off_W + span_W * smooth5(progress);
  out.v_W = span_W * smooth5_derivative(progress) / swing_s;

  const double apex = std::max(lift_off_W.z(), target_W.z()) + config.clearance_m;
  const bool rising = progress < config.apex_at;
  const double from = rising ? lift_off_W.z() : apex;
  const double to = rising ? apex : target_W.z();
  const double part = rising ? config.apex_at : 1.0 - config.apex_at;
  const double s = rising ? progress / part : (progress - config.apex_at) / part;
  out.p_W.z() = from + (to - from) * smooth5(s);
  out.v_W.z() = (to - from) * smooth5_derivative(s) / (part * swing_s);
  return out;
}

Eigen::Vector3d swing_torque(const SwingConfig& config, const BodyState& state, const Posture& posture,
                             const FootTarget& target, std::size_t leg) {
  const Eigen::Quaterniond q_RW = state.X_WR.q.conjugate();
  const LegAngles q_target = leg_angles(leg, q_RW * (target.p_W - state.X_WR.t));
  const Eigen::Vector3d lever_W = posture.foot_W[leg] - state.X_WR.t;
  const Eigen::Vector3d v_R = q_RW * (target.v_W - state.v_W - state.omega_W.cross(lever_W));
  const Eigen::Matrix3d& J = posture.jacobian_R[leg];
  const Eigen::Matrix3d damped = J.transpose() * J + config.damping * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d qd_target =
      (damped.inverse() * (J.transpose() * v_R)).cwiseMax(-config.joint_speed_max).cwiseMin(config.joint_speed_max);
  return config.kp * (q_target - state.q[leg]) + config.kd * (qd_target - state.qd[leg]) + state.bias[leg];
}

}  // namespace plumbline::sim
