// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace plumbline {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rigid transform. A value named X_AB is the pose of frame B in frame A and maps points from B to A:
/// p_A = X_AB * p_B, X_AC = X_AB * X_BC.
struct Pose {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< rotation, unit quaternion
  Eigen::Vector3d t = Eigen::Vector3d::Zero();            ///< translation, m

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p_B) const { return q * p_B + t; }
  [[nodiscard]] Pose operator*(const Pose& X_BC) const;
  [[nodiscard]] Pose inverse() const;
  [[nodiscard]] Eigen::Matrix3d rotation() const { return q.toRotationMatrix(); }

  /// Heading of the x axis in the xy plane, rad in (-pi, pi].
  [[nodiscard]] double yaw() const;
  /// Pose in the plane: (x, y, z) and a rotation about z, rad.
  [[nodiscard]] static Pose from_xyz_yaw(const Eigen::Vector3d& t, double yaw);
};

/// Rotation vector (rad) to unit quaternion.
[[nodiscard]] Eigen::Quaterniond exp_so3(const Eigen::Vector3d& w);
/// Unit quaternion to rotation vector, norm in [0, pi].
[[nodiscard]] Eigen::Vector3d log_so3(const Eigen::Quaterniond& q);
/// Of a right increment (rho, phi) of X_AB, as a left one: Exp(adjoint(X) xi) X = X Exp(xi).
[[nodiscard]] Matrix6d adjoint(const Pose& X_AB);
/// Cross-product matrix: hat(a) * b == a x b.
[[nodiscard]] Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/// SE(3) exponential of a twist (rho in m, phi in rad).
[[nodiscard]] Pose exp_se3(const Vector6d& xi);
/// SE(3) logarithm, inverse of exp_se3 for rotations below pi.
[[nodiscard]] Vector6d log_se3(const Pose& X);
/// Interpolates from X_WA (s = 0) to X_WB (s = 1): translation linear, rotation along the shortest arc.
[[nodiscard]] Pose interpolate(const Pose& X_WA, const Pose& X_WB, double s);
/// Angle wrapped to (-pi, pi].
[[nodiscard]] double wrap_angle(double angle);

}  // namespace plumbline
