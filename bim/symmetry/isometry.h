// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "bim/geometry/polygon.h"

namespace plumbline::bim {

/// Isometry of the plane: p' = R(angle) M p + t, with M = diag(1, -1) where mirrored and the identity otherwise.
struct Isometry2 {
  double angle = 0.0;  ///< rad, in (-pi, pi]
  Eigen::Vector2d t = Eigen::Vector2d::Zero();
  bool mirrored = false;

  /// Turn by an angle about a point.
  [[nodiscard]] static Isometry2 turn(double angle, const Eigen::Vector2d& about);
  /// The isometry that turns (and mirrors) in this way and takes p to q.
  [[nodiscard]] static Isometry2 taking(double angle, bool mirrored, const Eigen::Vector2d& p,
                                        const Eigen::Vector2d& q);

  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return linear(p) + t; }
  /// Image of a direction.
  [[nodiscard]] Eigen::Vector2d linear(const Eigen::Vector2d& v) const;
  [[nodiscard]] Isometry2 operator*(const Isometry2& first) const;
  [[nodiscard]] Isometry2 inverse() const;
  /// Image of a counter-clockwise polygon, counter-clockwise.
  [[nodiscard]] Polygon2 operator*(const Polygon2& polygon) const;
  /// The point a turn leaves where it is; absent for translations and mirror images.
  [[nodiscard]] std::optional<Eigen::Vector2d> centre() const;
};

}  // namespace plumbline::bim
