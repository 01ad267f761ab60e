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

/// Ground under a point at or below z_max.
double ground(const Terrain& terrain, const Eigen::Vector3d& p_W, double z_max) {
  return terrain(p_W.x(), p_W.y(), z_max);
}

bool rough(const FootholdConfig& config, const Terrain& terrain, const Eigen::Vector3d& p_W, double yaw, double z_max) {
  const double z = ground(terrain, p_W, z_max);
  const Eigen::Vector3d ahead_W = rotate_z(yaw, {config.probe_m, 0.0, 0.0});
  const Eigen::Vector3d left_W(-ahead_W.y(), ahead_W.x(), 0.0);
  for (const Eigen::Vector3d& d_W : {ahead_W, Eigen::Vector3d(-ahead_W), left_W, Eigen::Vector3d(-left_W)})
    if (std::abs(ground(terrain, p_W + d_W, z_max) - z) > config.rough_m) return true;
  return false;
}

/// The nearest place to p_W with even ground around it, or p_W itself.
Eigen::Vector3d even_place(const FootholdConfig& config, const Terrain& terrain, const Eigen::Vector3d& p_W, double yaw,
                           double z_max) {
  if (!rough(config, terrain, p_W, yaw, z_max)) return p_W;
  Eigen::Vector3d best_W = p_W;
  double best = config.rough_cost_m2;
  for (int i = -config.search_along; i <= config.search_along; ++i)
    for (int j = -config.search_across; j <= config.search_across; ++j) {
      const Eigen::Vector3d d_W = rotate_z(yaw, {i * config.search_step_m, j * config.search_step_m, 0.0});
      const double cost = d_W.squaredNorm();
      if (cost >= best || rough(config, terrain, p_W + d_W, yaw, z_max)) continue;
      best = cost;
      best_W = p_W + d_W;
    }
  return best_W;
}

}  // namespace

bool at_ground_level(const ContactConfig& config, const Terrain& terrain, double z_max, const Eigen::Vector3d& foot_W) {
  const double sole = foot_W.z() - robot_dimensions.foot_radius;
  const double d = config.early_near_m;
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(d, 0, 0), Eigen::Vector3d(-d, 0, 0),
                                     Eigen::Vector3d(0, d, 0), Eigen::Vector3d(0, -d, 0)})
    if (std::abs(sole - ground(terrain, foot_W + off, z_max)) < config.early_off_m) return true;
  return false;
}

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

  Eigen::Vector3d p_W = even_place(config, terrain, base_W + offset_W, yaw, state.X_WR.t.z());
  p_W.z() = terrain(p_W.x(), p_W.y(), state.X_WR.t.z()) + d.foot_radius - config.below_ground_m;
  return p_W;
}

bool over_steps(const SwingConfig& config, const Terrain& terrain, double z_max, const Eigen::Vector3d& from_W,
                const Eigen::Vector3d& to_W) {
  double low = ground(terrain, from_W, z_max);
  double high = low;
  for (int i = 1; i <= config.way_points; ++i) {
    const double z = ground(terrain, from_W + (to_W - from_W) * i / config.way_points, z_max);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return high - low > config.steps_m;
}

SwingPath swing_path(const SwingConfig& config, const Terrain& terrain, double z_max, const Eigen::Vector3d& from_W,
                     const Eigen::Vector3d& to_W, bool steps) {
  SwingPath path{from_W, to_W, std::max(from_W.z(), to_W.z()) + config.clearance_m, steps};
  if (!steps) return path;
  const bool up = to_W.z() - from_W.z() > config.step_m;
  path.across_from = up ? config.up_across_from : config.across_from;
  path.across_to = up ? config.up_across_to : config.across_to;
  for (int i = 1; i <= config.way_points; ++i) {
    const double z = ground(terrain, from_W + (to_W - from_W) * i / (config.way_points + 1), z_max);
    path.apex_z_W = std::max(path.apex_z_W, z + robot_dimensions.foot_radius + config.over_ground_m);
  }
  return path;
}

void wait_for_height(const SwingConfig& config, const Terrain& terrain, double z_max, const Eigen::Vector3d& foot_W,
                     double progress_step, SwingPath& path) {
  const Eigen::Vector3d left_W = horizontal(path.to_W - foot_W);
  const double distance = left_W.norm();
  if (!path.steps || distance < config.ahead_m) return;
  const double ahead = ground(terrain, foot_W + left_W * (config.ahead_m / distance), z_max);
  if (foot_W.z() > ahead + robot_dimensions.foot_radius) return;
  path.across_from = std::min(config.across_latest, path.across_from + config.wait_rate * progress_step);
}

FootTarget swing_point(const SwingConfig& config, const SwingPath& path, double progress, double swing_s) {
  const Eigen::Vector3d span_W = path.to_W - path.from_W;
  const double length = path.across_to - path.across_from;
  const double across = std::clamp((progress - path.across_from) / length, 0.0, 1.0);
  FootTarget out;
  out.p_W = path.from_W + span_W * smooth5(across);
  out.v_W = span_W * smooth5_derivative(across) / (length * swing_s);

  double apex_at = config.apex_at;
  if (path.steps && span_W.z() > config.step_m) apex_at = config.apex_up_at;
  if (path.steps && span_W.z() < -config.step_m) apex_at = config.apex_down_at;
  const bool rising = progress < apex_at;
  const double from = rising ? path.from_W.z() : path.apex_z_W;
  const double to = rising ? path.apex_z_W : path.to_W.z();
  const double part = rising ? apex_at : 1.0 - apex_at;
  const double s = rising ? progress / part : (progress - apex_at) / part;
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
