// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/model/hull.h"

namespace plumbline::bim {

namespace {

constexpr std::size_t triangles_max = 20000;  ///< of a solid that is taken by its triangles

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

bool inside_convex(const Polygon2& convex, const Eigen::Vector2d& p) {
  if (convex.size() < 3) return false;
  for (std::size_t i = 0; i < convex.size(); ++i)
    if (cross(convex[(i + 1) % convex.size()] - convex[i], p - convex[i]) < 0.0) return false;
  return true;
}

std::size_t edges_of(const Polygon2& convex) { return convex.size() < 3 ? 1 : convex.size(); }

bool edges_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                 const Eigen::Vector2d& d) {
  const double abc = cross(b - a, c - a), abd = cross(b - a, d - a);
  const double cda = cross(d - c, a - c), cdb = cross(d - c, b - c);
  return abc * abd < 0.0 && cda * cdb < 0.0;
}

double distance_to(const Polygon2& convex, const Eigen::Vector2d& p) {
  if (inside_convex(convex, p)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < edges_of(convex); ++i)
    least = std::min(least, segment_distance(convex[i], convex[(i + 1) % convex.size()], p));
  return least;
}

bool corners_near(const Polygon2& corners, const Polygon2& convex, double gap_m) {
  return std::any_of(corners.begin(), corners.end(),
                     [&](const Eigen::Vector2d& p) { return distance_to(convex, p) < gap_m; });
}

Eigen::AlignedBox2d box_around(const Polygon2& corners) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : corners) box.extend(p);
  return box;
}

using Corners = std::vector<Eigen::Vector3d>;

/// The part of a convex polygon on which sign (z - z_m) is not negative.
Corners clipped(const Corners& corners, double z_m, double sign) {
  Corners kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d &p = corners[i], &q = corners[(i + 1) % corners.size()];
    const double dp = sign * (p.z() - z_m), dq = sign * (q.z() - z_m);
    if (dp >= 0.0) kept.push_back(p);
    if (dp * dq < 0.0) kept.emplace_back(p + dp / (dp - dq) * (q - p));
  }
  return kept;
}

/// What is upright is seen as a line.
Polygon2 line_of(const Polygon2& points) {
  Polygon2 line = {points.front(), points.front()};
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      if ((points[j] - points[i]).norm() > (line[1] - line[0]).norm()) line = {points[i], points[j]};
  return line;
}

/// The triangles of a solid within a band of heights, seen from above.
struct Projection {
  std::vector<Polygon2> parts;
  Polygon2 points;
  double up_m2 = 0.0, down_m2 = 0.0;  ///< of those that face up and down

  void add(Polygon2 flat) {
    const double area = signed_area(flat);
    (area > 0.0 ? up_m2 : down_m2) += std::abs(area);
    points.insert(points.end(), flat.begin(), flat.end());
    if (parts.size() <= triangles_max) parts.push_back(std::move(flat));
  }
};

/// Tops above the band with nothing but the solid below them: it goes through the band.
std::vector<Polygon2> tops_of(const std::vector<Polygon2>& above) {
  constexpr std::size_t looked_at_max = 2000;
  std::vector<Polygon2> tops, undersides;
  for (const Polygon2& flat : above) {
    const double area = signed_area(flat);
    if (area > 0.0) tops.push_back(flat);
    if (area < 0.0) undersides.push_back({flat[0], flat[2], flat[1]});
  }
  if (above.size() > looked_at_max) return tops;
  std::erase_if(tops, [&](const Polygon2& top) {
    const Eigen::Vector2d middle = (top[0] + top[1] + top[2]) / 3.0;
    return std::any_of(undersides.begin(), undersides.end(),
                       [&](const Polygon2& underside) { return inside_convex(underside, middle); });
  });
  return tops;
}

Projection project(const Solid& solid, double z0_m, double z1_m) {
  Projection seen;
  std::vector<Polygon2> above;
  bool reaches_down = false;
  for (const Eigen::Vector3i& triangle : solid.triangles) {
    Corners corners;
    for (int i = 0; i < 3; ++i) corners.push_back(solid.vertices[static_cast<std::size_t>(triangle[i])]);
    const auto flat = [](const Corners& points) {
      Polygon2 seen_from_above;
      for (const Eigen::Vector3d& p : points) seen_from_above.push_back(p.head<2>());
      return seen_from_above;
    };
    const bool is_above = std::min({corners[0].z(), corners[1].z(), corners[2].z()}) >= z1_m;
    reaches_down = reaches_down || !is_above;
    if (is_above) above.push_back(flat(corners));
    corners = clipped(clipped(corners, z0_m, 1.0), z1_m, -1.0);
    if (!corners.empty()) seen.add(flat(corners));
  }
  if (reaches_down)
    for (Polygon2& top : tops_of(above)) seen.add(std::move(top));
  return seen;
}

}  // namespace

void Footprint::add(Polygon2 convex) {
  box.extend(box_around(convex));
  parts.push_back(std::move(convex));
}

Polygon2 turned_rectangle(const Eigen::Vector2d& at, const Eigen::Vector2d& size, double yaw) {
  const Eigen::Rotation2Dd turn(yaw);
  Polygon2 polygon;
  for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    polygon.push_back(at + turn * Eigen::Vector2d(x * size.x(), y * size.y()));
  return polygon;
}

Footprint footprint_of(Polygon2 convex) {
  Footprint footprint;
  footprint.add(std::move(convex));
  return footprint;
}

Footprint footprint_of(const Solid& solid, double z0_m, double z1_m) {
  constexpr double fuller = 1.25, spare_m2 = 0.05;
  Projection seen = project(solid, z0_m, z1_m);
  Footprint footprint;
  if (seen.parts.empty()) return footprint;
  Polygon2 hull = convex_hull(std::move(seen.points));
  const bool full = hull.size() >= 3 && signed_area(hull) <= fuller * std::max(seen.up_m2, seen.down_m2) + spare_m2;
  if (full || (hull.size() >= 3 && seen.parts.size() > triangles_max)) {
    footprint.add(std::move(hull));
    return footprint;
  }
  for (Polygon2& part : seen.parts) {
    Polygon2 convex = convex_hull(part);
    footprint.add(convex.size() < 3 ? line_of(part) : std::move(convex));
  }
  return footprint;
}

Footprint moved(Footprint footprint, const Eigen::Vector2d& about, double yaw, const Eigen::Vector2d& by) {
  const Eigen::Rotation2Dd turn(yaw);
  Footprint result;
  for (Polygon2& part : footprint.parts) {
    for (Eigen::Vector2d& p : part) p = about + turn * Eigen::Vector2d(p - about) + by;
    result.add(std::move(part));
  }
  return result;
}

double distance(const Footprint& footprint, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Polygon2& part : footprint.parts) least = std::min(least, distance_to(part, p));
  return least;
}

bool nearer_than(const Polygon2& convex_a, const Polygon2& convex_b, double gap_m) {
  if (box_around(convex_a).exteriorDistance(box_around(convex_b)) >= gap_m && gap_m > 0.0) return false;
  const double gap = std::max(gap_m, 1e-9);
  if (corners_near(convex_a, convex_b, gap) || corners_near(convex_b, convex_a, gap)) return true;
  for (std::size_t i = 0; i < edges_of(convex_a); ++i)
    for (std::size_t j = 0; j < edges_of(convex_b); ++j)
      if (edges_cross(convex_a[i], convex_a[(i + 1) % convex_a.size()], convex_b[j],
                      convex_b[(j + 1) % convex_b.size()]))
        return true;
  return false;
}

bool nearer_than(const Footprint& a, const Footprint& b, double gap_m) {
  if (a.parts.empty() || b.parts.empty() || a.box.exteriorDistance(b.box) > gap_m) return false;
  for (const Polygon2& part : a.parts)
    for (const Polygon2& other : b.parts)
      if (nearer_than(part, other, gap_m)) return true;
  return false;
}

}  // namespace plumbline::bim
