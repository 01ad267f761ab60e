// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/overlap.h"

#include <Eigen/Geometry>
#include <cmath>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool boxes_meet(const Polygon2& a, const Polygon2& b) {
  Eigen::AlignedBox2d box_a, box_b;
  for (const Vector2d& p : a) box_a.extend(p);
  for (const Vector2d& p : b) box_b.extend(p);
  return box_a.intersects(box_b);
}

/// What of the polygon lies left of the line from p to q.
Polygon2 left_of(const Polygon2& polygon, const Vector2d& p, const Vector2d& q) {
  Polygon2 kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double side_a = cross(q - p, a - p), side_b = cross(q - p, b - p);
    if (side_a >= 0.0) kept.push_back(a);
    if ((side_a >= 0.0) != (side_b >= 0.0)) kept.push_back(a + (b - a) * (side_a / (side_a - side_b)));
  }
  return kept;
}

}  // namespace

bool is_convex(const Polygon2& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t k = 0; k < n; ++k)
    if (cross(polygon[(k + 1) % n] - polygon[k], polygon[(k + 2) % n] - polygon[(k + 1) % n]) < 0.0) return false;
  return true;
}

double overlap_area(const Polygon2& a, const Polygon2& b) {
  if (a.size() < 3 || b.size() < 3 || !boxes_meet(a, b)) return 0.0;
  const bool b_convex = is_convex(b);
  if (!b_convex && !is_convex(a)) return intersection_area(a, b);
  // Clipping a polygon that is not convex may leave edges that run there and back along the clip, which add no area.
  const Polygon2& clip = b_convex ? b : a;
  Polygon2 shared = b_convex ? a : b;
  for (std::size_t k = 0; k < clip.size() && shared.size() > 2; ++k)
    shared = left_of(shared, clip[k], clip[(k + 1) % clip.size()]);
  return shared.size() > 2 ? std::abs(signed_area(shared)) : 0.0;
}

}  // namespace plumbline::slam
