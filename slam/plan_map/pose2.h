// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline::slam {

/// Rigid transform in the horizontal plane; X_AB maps points from B to A.
struct Pose2 {
  Eigen::Vector2d t = Eigen::Vector2d::Zero();  ///< m
  double yaw = 0.0;                             ///< rad, in (-pi, pi]

  [[nodiscard]] Eigen::Matrix2d rotation() const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return (Eigen::Matrix2d() << c, -s, s, c).finished();
  }
  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p_B) const { return rotation() * p_B + t; }
  [[nodiscard]] Pose2 operator*(const Pose2& X_BC) const {
    return {rotation() * X_BC.t + t, wrap_angle(yaw + X_BC.yaw)};
  }
  [[nodiscard]] Pose2 inverse() const { return {-(rotation().transpose() * t), wrap_angle(-yaw)}; }
};

[[nodiscard]] inline bool is_near(const Pose2& a, const Pose2& b, double near_m, double near_rad) {
  return (a.t - b.t).norm() <= near_m && std::abs(wrap_angle(a.yaw - b.yaw)) <= near_rad;
}

/// Heading frame of a 3D pose: its position in the horizontal plane and its yaw.
[[nodiscard]] inline Pose2 heading(const Pose& X_AB) { return {X_AB.t.head<2>(), X_AB.yaw()}; }

}  // namespace plumbline::slam
