// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/errors.h"

namespace plumbline {

namespace {

constexpr double boundary_tolerance_m = 1e-9;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the signed area of the triangle a, b, c.
double orient(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return cross(b - a, c - a);
}

/// c, known to be collinear with a and b, lies on the segment a-b.
bool in_box(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (c.array() >= a.cwiseMin(b).array()).all() && (c.array() <= a.cwiseMax(b).array()).all();
}

int sign(double v) { return (v > 0.0) - (v < 0.0); }

bool segments_touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
  const int abc = sign(orient(a, b, c)), abd = sign(orient(a, b, d));
  const int cda = sign(orient(c, d, a)), cdb = sign(orient(c, d, b));
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && in_box(a, b, c)) || (abd == 0 && in_box(a, b, d)) || (cda == 0 && in_box(c, d, a)) ||
         (cdb == 0 && in_box(c, d, b));
}

/// Edges p-q and q-r run back over each other.
bool folds_back(const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
  return orient(p, q, r) == 0.0 && (q - p).dot(r - q) <= 0.0;
}

/// Signed depth of p: distance to the boundary, negative outside.
double depth(const Polygon2& polygon, const Eigen::Vector2d& p) {
  const double distance = boundary_distance(polygon, p);
  return contains(polygon, p) ? distance : -distance;
}

/// Deepest of (2 n + 1)^2 grid points within +-half of centre; of equal points the first by x, then y.
Eigen::Vector2d deepest(const Polygon2& polygon, const Eigen::Vector2d& centre, const Eigen::Vector2d& half, int n) {
  Eigen::Vector2d best = centre;
  double best_depth = -std::numeric_limits<double>::infinity();
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const Eigen::Vector2d p = centre + Eigen::Vector2d(i, j).cwiseProduct(half) / n;
      const double d = depth(polygon, p);
      if (d > best_depth) {
        best = p;
        best_depth = d;
      }
    }
  }
  return best;
}

}  // namespace

double signed_area(const Polygon2& polygon) {
  if (polygon.empty()) return 0.0;
  const Eigen::Vector2d origin = polygon.front();
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i] - origin, polygon[(i + 1) % polygon.size()] - origin);
  return 0.5 * twice;
}

Eigen::Vector2d centroid(const Polygon2& polygon) {
  if (polygon.empty()) throw InternalError("centroid of a polygon without vertices");
  const Eigen::Vector2d origin = polygon.front();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d p = polygon[i] - origin;
    const Eigen::Vector2d q = polygon[(i + 1) % polygon.size()] - origin;
    const double c = cross(p, q);
    twice += c;
    moment += c * (p + q);
    mean += p;
  }
  if (twice == 0.0) return origin + mean / static_cast<double>(polygon.size());
  return origin + moment / (3.0 * twice);
}

double segment_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - (a + s * d)).norm();
}

double boundary_distance(const Polygon2& polygon, const Eigen::Vector2d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    best = std::min(best, segment_distance(polygon[i], polygon[(i + 1) % polygon.size()], p));
  return best;
}

double boundary_distance(const Polygon2& outline, std::span<const Polygon2> holes, const Eigen::Vector2d& p) {
  double best = boundary_distance(outline, p);
  for (const Polygon2& hole : holes) best = std::min(best, boundary_distance(hole, p));
  return best;
}

bool contains(const Polygon2& outline, std::span<const Polygon2> holes, const Eigen::Vector2d& p) {
  constexpr double rim_m = 1e-9;
  return contains(outline, p) && std::none_of(holes.begin(), holes.end(), [&](const Polygon2& hole) {
           return contains(hole, p) && boundary_distance(hole, p) > rim_m;
         });
}

bool contains(const Polygon2& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if (segment_distance(a, b, p) <= boundary_tolerance_m) return true;
    if ((a.y() > p.y()) != (b.y() > p.y()) && (orient(a, b, p) > 0.0) == (b.y() > a.y())) inside = !inside;
  }
  return inside;
}

bool is_simple(const Polygon2& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % n];
    if (a == b || folds_back(a, b, polygon[(i + 2) % n])) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      const bool neighbours = i == 0 && j == n - 1;
      if (!neighbours && segments_touch(a, b, polygon[j], polygon[(j + 1) % n])) return false;
    }
  }
  return signed_area(polygon) != 0.0;
}

Eigen::Vector2d interior_point(const Polygon2& polygon) {
  if (polygon.empty()) throw InternalError("interior point of a polygon without vertices");
  Eigen::Vector2d low = polygon.front(), high = polygon.front();
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr int coarse_half_cells = 16;
  constexpr int fine_half_cells = 2;
  constexpr int refinements = 20;
  Eigen::Vector2d half = 0.5 * (high - low);
  Eigen::Vector2d best = deepest(polygon, 0.5 * (low + high), half, coarse_half_cells);
  half /= coarse_half_cells;
  for (int i = 0; i < refinements; ++i) {
    best = deepest(polygon, best, half, fine_half_cells);
    half *= 0.6;
  }
  return best;
}

}  // namespace plumbline
