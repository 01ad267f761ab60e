// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace plumbline {

/// Simple polygon, vertices in order, the last joined to the first. Counter-clockwise where a function says so.
using Polygon2 = std::vector<Eigen::Vector2d>;

/// Outer boundary counter-clockwise, holes clockwise.
struct PolygonWithHoles2 {
  Polygon2 outer;
  std::vector<Polygon2> holes;
};

/// Signed area, m^2, positive when counter-clockwise.
[[nodiscard]] double signed_area(const Polygon2& polygon);
[[nodiscard]] Eigen::Vector2d centroid(const Polygon2& polygon);
/// True inside or within 1e-9 m of the boundary.
[[nodiscard]] bool contains(const Polygon2& polygon, const Eigen::Vector2d& p);
/// Distance to the boundary, m, whether p is inside or outside.
[[nodiscard]] double boundary_distance(const Polygon2& polygon, const Eigen::Vector2d& p);
/// The same of an outline with holes, whose rims are boundary as well.
[[nodiscard]] bool contains(const Polygon2& outline, std::span<const Polygon2> holes, const Eigen::Vector2d& p);
[[nodiscard]] double boundary_distance(const Polygon2& outline, std::span<const Polygon2> holes,
                                       const Eigen::Vector2d& p);
/// Distance of p to the segment a-b, m.
[[nodiscard]] double segment_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p);
/// True when no two edges touch except neighbours in their common vertex, and the area is not 0.
[[nodiscard]] bool is_simple(const Polygon2& polygon);
/// A point well inside (the inner point farthest from the boundary on a coarse grid, then refined).
[[nodiscard]] Eigen::Vector2d interior_point(const Polygon2& polygon);
/// Area of the intersection of two simple polygons, m^2 (exact booleans).
[[nodiscard]] double intersection_area(const Polygon2& a, const Polygon2& b);

}  // namespace plumbline
