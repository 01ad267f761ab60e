// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/isometry.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/pose.h"

namespace plumbline::bim {

namespace {

Eigen::Vector2d turned(double angle, const Eigen::Vector2d& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace

Isometry2 Isometry2::turn(double angle, const Eigen::Vector2d& about) { return taking(angle, false, about, about); }

Isometry2 Isometry2::taking(double angle, bool mirrored, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  Isometry2 result{wrap_angle(angle), Eigen::Vector2d::Zero(), mirrored};
  result.t = q - result.linear(p);
  return result;
}

Eigen::Vector2d Isometry2::linear(const Eigen::Vector2d& v) const {
  return turned(angle, mirrored ? Eigen::Vector2d(v.x(), -v.y()) : v);
}

Isometry2 Isometry2::operator*(const Isometry2& first) const {
  const double sum = mirrored ? angle - first.angle : angle + first.angle;
  return {wrap_angle(sum), linear(first.t) + t, mirrored != first.mirrored};
}

Isometry2 Isometry2::inverse() const {
  Isometry2 result{mirrored ? angle : wrap_angle(-angle), Eigen::Vector2d::Zero(), mirrored};
  result.t = -result.linear(t);
  return result;
}

Polygon2 Isometry2::operator*(const Polygon2& polygon) const {
  Polygon2 image;
  image.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) image.push_back(*this * p);
  if (mirrored) std::reverse(image.begin(), image.end());
  return image;
}

std::optional<Eigen::Vector2d> Isometry2::centre() const {
  constexpr double smallest_turn = 1e-6;
  if (mirrored || std::abs(angle) < smallest_turn) return std::nullopt;
  // (I - R) c = t
  const double c = std::cos(angle), s = std::sin(angle), scale = 0.5 / (1.0 - c);
  return Eigen::Vector2d(scale * ((1.0 - c) * t.x() - s * t.y()), scale * (s * t.x() + (1.0 - c) * t.y()));
}

}  // namespace plumbline::bim
