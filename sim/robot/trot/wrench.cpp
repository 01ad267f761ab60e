// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/wrench.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plumbline::sim {

namespace {

/// Trunk along the support plane, facing the yaw reference.
Eigen::Quaterniond desired_orientation(const Eigen::Vector3d& normal_W, double yaw) {
  const Eigen::Vector3d heading_W(std::cos(yaw), std::sin(yaw), 0.0);
  Eigen::Matrix3d R;
  R.col(2) = normal_W;
  R.col(0) = (heading_W - heading_W.dot(normal_W) * normal_W).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return Eigen::Quaterniond(R);
}

Eigen::Vector3d desired_force(const PostureConfig& c, const BodyState& state, const Reference& reference,
                              const SupportPlane& plane, double mass) {
  const Eigen::Vector3d& n = plane.normal_W();
  const Eigen::Vector3d& v_ref = reference.v_W();
  Eigen::Vector2d f_xy =
      mass * (c.kd_xy * (v_ref - state.v_W).head<2>() + c.kp_xy * (reference.position_W() - state.X_WR.t.head<2>()));
  const double limit = c.horizontal_max_g * mass * gravity;
  if (f_xy.norm() > limit) f_xy *= limit / f_xy.norm();

  const double z_ref = plane.ground_height(state.X_WR.t) + c.height_m;
  const double vz_ref = -(n.x() * v_ref.x() + n.y() * v_ref.y()) / n.z();
  const double fz = mass * (gravity + c.kp_z * (z_ref - state.X_WR.t.z()) + c.kd_z * (vz_ref - state.v_W.z()));
  return {f_xy.x(), f_xy.y(), std::clamp(fz, c.vertical_min_g * mass * gravity, c.vertical_max_g * mass * gravity)};
}

Eigen::Vector3d desired_torque(const PostureConfig& c, const BodyState& state, const Reference& reference,
                               const SupportPlane& plane) {
  const Eigen::Quaterniond q_WY = exp_so3({0.0, 0.0, state.X_WR.yaw()});
  const Eigen::Quaterniond q_ref = desired_orientation(plane.normal_W(), reference.yaw());
  const Eigen::Vector3d error_Y = q_WY.conjugate() * log_so3(q_ref * state.X_WR.q.conjugate());
  const Eigen::Vector3d rate_Y = q_WY.conjugate() * (Eigen::Vector3d(0.0, 0.0, reference.yaw_rate()) - state.omega_W);
  const Eigen::Vector3d inertia(c.inertia_roll, c.inertia_pitch, c.inertia_yaw);
  const Eigen::Vector3d kp(c.kp_tilt, c.kp_tilt, c.kp_yaw);
  const Eigen::Vector3d kd(c.kd_tilt, c.kd_tilt, c.kd_yaw);
  return q_WY * inertia.cwiseProduct(kp.cwiseProduct(error_Y) + kd.cwiseProduct(rate_Y));
}

}  // namespace

Eigen::Vector3d stance_center(const PerLeg<LegContact>& legs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const LegContact& leg : legs) sum += leg.last_stance_W;
  return sum / static_cast<double>(leg_count);
}

void SupportPlane::update(const PerLeg<LegContact>& legs, double dt) {
  mean_W_ = stance_center(legs);
  Eigen::Matrix3d N = config_.plane_damping * Eigen::Matrix3d::Identity();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  for (const LegContact& leg : legs) {
    const Eigen::Vector3d p = leg.last_stance_W - mean_W_;
    const Eigen::Vector3d row(p.x(), p.y(), 1.0);
    N += row * row.transpose();
    rhs += row * p.z();
  }
  const Eigen::Vector3d abc = N.inverse() * rhs;
  const Eigen::Vector3d normal_W = Eigen::Vector3d(-abc.x(), -abc.y(), 1.0).normalized();
  normal_W_ = (normal_W_ + dt / config_.normal_time_constant_s * (normal_W - normal_W_)).normalized();
}

double SupportPlane::ground_height(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d d = p_W - mean_W_;
  return mean_W_.z() - robot_dimensions.foot_radius - (normal_W_.x() * d.x() + normal_W_.y() * d.y()) / normal_W_.z();
}

Wrench desired_wrench(const PostureConfig& config, const BodyState& state, const Reference& reference,
                      const SupportPlane& plane, double mass) {
  Wrench wrench;
  wrench << desired_force(config, state, reference, plane, mass), desired_torque(config, state, reference, plane);
  return wrench;
}

}  // namespace plumbline::sim
