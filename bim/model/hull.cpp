// SPDX-License-Identifier: Apache-2.0
#include "bim/model/hull.h"

#include <algorithm>

#include "bim/geometry/interval.h"

namespace plumbline::bim {

namespace {

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

}  // namespace

// Andrew's monotone chain.
Polygon2 convex_hull(Polygon2 points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return {};
  Polygon2 hull;
  const auto add = [&](const Eigen::Vector2d& p, std::size_t base) {
    while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Eigen::Vector2d& p : points) add(p, 0);
  const std::size_t base = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, base);
  hull.pop_back();
  return hull;
}

ThinRectangle thinnest_rectangle(const Polygon2& hull) {
  ThinRectangle best;
  for (std::size_t i = 0; hull.size() >= 3 && i < hull.size(); ++i) {
    const Eigen::Vector2d e = (hull[(i + 1) % hull.size()] - hull[i]).normalized(), left(-e.y(), e.x());
    Interval along, across;
    for (const Eigen::Vector2d& p : hull) {
      along.add(p.dot(e));
      across.add(p.dot(left));
    }
    if (i > 0 && across.length() >= best.width_m) continue;
    const Eigen::Vector2d middle = 0.5 * (across.low + across.high) * left;
    best = {along.low * e + middle, along.high * e + middle, across.length()};
  }
  return best;
}

}  // namespace plumbline::bim
