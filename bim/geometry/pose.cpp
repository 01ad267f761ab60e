// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/pose.h"

#include <cmath>
#include <numbers>

namespace plumbline {

namespace {

/// Left Jacobian of SO(3): maps rho to the translation of exp_se3.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
  const double theta = w.norm();
  const Eigen::Matrix3d W = hat(w);
  if (theta < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6.0;
  const double theta2 = theta * theta;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(theta)) / theta2 * W +
         (theta - std::sin(theta)) / (theta2 * theta) * W * W;
}

}  // namespace

Pose Pose::operator*(const Pose& X_BC) const { return {(q * X_BC.q).normalized(), q * X_BC.t + t}; }

Pose Pose::inverse() const {
  const Eigen::Quaterniond q_inv = q.conjugate();
  return {q_inv, -(q_inv * t)};
}

double Pose::yaw() const {
  const Eigen::Vector3d x = q * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x());
}

Pose Pose::from_xyz_yaw(const Eigen::Vector3d& t, double yaw) { return {exp_so3(Eigen::Vector3d(0.0, 0.0, yaw)), t}; }

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& w) {
  const double theta = w.norm();
  const double half = 0.5 * theta;
  const double k = theta < 1e-8 ? 0.5 - theta * theta / 48.0 : std::sin(half) / theta;
  return Eigen::Quaterniond(std::cos(half), k * w.x(), k * w.y(), k * w.z()).normalized();
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& q_any) {
  const Eigen::Quaterniond q = q_any.w() < 0.0 ? Eigen::Quaterniond(-q_any.coeffs()) : q_any;
  const double n = q.vec().norm();
  if (n < 1e-10) return 2.0 * q.vec();
  return (2.0 * std::atan2(n, q.w()) / n) * q.vec();
}

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

Matrix6d adjoint(const Pose& X_AB) {
  const Eigen::Matrix3d R = X_AB.rotation();
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = R;
  A.topRightCorner<3, 3>() = hat(X_AB.t) * R;
  return A;
}

Pose exp_se3(const Vector6d& xi) { return {exp_so3(xi.tail<3>()), left_jacobian(xi.tail<3>()) * xi.head<3>()}; }

Vector6d log_se3(const Pose& X) {
  Vector6d xi;
  xi.tail<3>() = log_so3(X.q);
  xi.head<3>() = left_jacobian(xi.tail<3>()).inverse() * X.t;
  return xi;
}

Pose interpolate(const Pose& X_WA, const Pose& X_WB, double s) {
  const Eigen::Vector3d w_A = log_so3(X_WA.q.conjugate() * X_WB.q);
  return {(X_WA.q * exp_so3(s * w_A)).normalized(), X_WA.t + s * (X_WB.t - X_WA.t)};
}

double wrap_angle(double angle) {
  constexpr double pi = std::numbers::pi;
  // What the remainder gives too, sooner.
  if (angle > -pi && angle <= pi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

}  // namespace plumbline
