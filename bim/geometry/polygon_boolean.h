// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/geometry/polygon.h"

namespace plumbline {

/// Grid of all coordinates that enter or leave the booleans below, m: fine against any building tolerance, coarse
/// against rounding in a file's coordinates.
inline constexpr double boolean_grid_m = 1e-4;

/// Pieces that share no inner point. Canonical: every ring starts at its lexicographically smallest vertex, holes and
/// pieces are in lexicographic order, no vertex lies within a straight edge of its ring, and rings are simple (one that
/// would touch itself in a vertex is split there). Rings do not cross, but may touch: so a corner may lie within an
/// edge of another ring, to the last bit of its decimals.
using Region2 = std::vector<PolygonWithHoles2>;

/// The nearest point of a grid that is one over a whole number, m: divided by that number, so that the result is the
/// double nearest to its decimals. Never -0.
[[nodiscard]] double snap(double value, double grid_m = boolean_grid_m);

/// Union of polygons of either orientation. Polygons that are not simple once snapped to the grid (slivers of a
/// projection) are left out.
[[nodiscard]] Region2 unite(std::span<const Polygon2> polygons);
/// Region without the union of the polygons.
[[nodiscard]] Region2 subtract(const Region2& region, std::span<const Polygon2> polygons);
[[nodiscard]] Region2 intersect(const Region2& a, const Region2& b);
/// Area of the region, m^2.
[[nodiscard]] double area(const Region2& region);
/// True inside or within 1e-9 m of the boundary.
[[nodiscard]] bool contains(const PolygonWithHoles2& polygon, const Eigen::Vector2d& p);

}  // namespace plumbline
