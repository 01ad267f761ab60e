// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon_boolean.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "bim/errors.h"
#include "bim/geometry/snap_rounding.h"

namespace plumbline {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Kernel>;
using ExactPiece = CGAL::Polygon_with_holes_2<Kernel>;
using ExactSet = CGAL::Polygon_set_2<Kernel>;

/// Without repeated vertices, in steps of the grid: there exact numbers stay whole, and what lies on a line does.
Polygon2 in_steps(const Polygon2& polygon) {
  Polygon2 ring;
  for (const Eigen::Vector2d& p : polygon) {
    const Eigen::Vector2d q(std::round(p.x() / boolean_grid_m), std::round(p.y() / boolean_grid_m));
    if (ring.empty() || ring.back() != q) ring.push_back(q);
  }
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  return ring;
}

ExactPolygon exact(const Polygon2& ring) {
  ExactPolygon result;
  for (const Eigen::Vector2d& p : ring) result.push_back(Kernel::Point_2(p.x(), p.y()));
  return result;
}

ExactPolygon counter_clockwise(const Polygon2& ring) {
  ExactPolygon result = exact(ring);
  if (result.is_clockwise_oriented()) result.reverse_orientation();
  return result;
}

ExactPolygon clockwise(const Polygon2& ring) {
  ExactPolygon result = counter_clockwise(ring);
  result.reverse_orientation();
  return result;
}

// Only two operations of CGAL are used, the union of a range and the difference: each further one costs a good part of
// a minute of compile time.

ExactSet joined(const std::vector<ExactPiece>& pieces) {
  ExactSet set;
  set.join(pieces.begin(), pieces.end());
  return set;
}

/// CGAL takes no ring with a vertex within an edge of another.
ExactSet exact(const Region2& region) {
  std::vector<ExactPiece> pieces;
  for (const PolygonWithHoles2& piece : region) {
    Region2 whole = {{in_steps(piece.outer), {}}};
    if (whole[0].outer.size() < 3) continue;
    for (const Polygon2& hole : piece.holes)
      if (Polygon2 ring = in_steps(hole); ring.size() >= 3) whole[0].holes.push_back(std::move(ring));
    if (!whole[0].holes.empty()) lead_through_corners(whole);
    pieces.emplace_back(counter_clockwise(whole[0].outer));
    for (const Polygon2& hole : whole[0].holes) pieces.back().add_hole(clockwise(hole));
  }
  return joined(pieces);
}

ExactSet joined(std::span<const Polygon2> polygons) {
  std::vector<ExactPiece> pieces;
  for (const Polygon2& polygon : polygons) {
    const Polygon2 ring = in_steps(polygon);
    if (is_simple(ring)) pieces.emplace_back(counter_clockwise(ring));
  }
  return joined(pieces);
}

/// a and b, as a without (a without b).
ExactSet common(const ExactSet& a, const ExactSet& b) {
  ExactSet outside_b = a;
  outside_b.difference(b);
  ExactSet result = a;
  result.difference(outside_b);
  return result;
}

/// The double nearest to an exact number: of one known to lie between two doubles, exact arithmetic says which.
double nearest(const Kernel::FT& number) {
  const auto [low, high] = CGAL::to_interval(number);
  return low == high ? low : CGAL::to_double(number.exact());
}

Polygon2 nearest(const ExactPolygon& polygon) {
  Polygon2 ring;
  for (const Kernel::Point_2& p : polygon.container()) ring.emplace_back(nearest(p.x()), nearest(p.y()));
  return ring;
}

Polygon2 in_metres(Polygon2 ring) {
  for (Eigen::Vector2d& p : ring) p = {snap(p.x() * boolean_grid_m), snap(p.y() * boolean_grid_m)};
  return ring;
}

Region2 canonical(const ExactSet& set) {
  std::vector<ExactPiece> pieces;
  set.polygons_with_holes(std::back_inserter(pieces));
  std::vector<Polygon2> rings;
  for (const ExactPiece& piece : pieces) {
    rings.push_back(nearest(piece.outer_boundary()));
    for (auto hole = piece.holes_begin(); hole != piece.holes_end(); ++hole) rings.push_back(nearest(*hole));
  }
  Region2 region = snap_rounded(rings);
  for (PolygonWithHoles2& piece : region) {
    piece.outer = in_metres(std::move(piece.outer));
    for (Polygon2& hole : piece.holes) hole = in_metres(std::move(hole));
  }
  return region;
}

double exact_area(const ExactSet& set) {
  std::vector<ExactPiece> pieces;
  set.polygons_with_holes(std::back_inserter(pieces));
  std::vector<double> areas;
  for (const ExactPiece& piece : pieces) {
    Kernel::FT sum = piece.outer_boundary().area();
    for (auto hole = piece.holes_begin(); hole != piece.holes_end(); ++hole) sum += hole->area();
    areas.push_back(CGAL::to_double(sum));
  }
  std::sort(areas.begin(), areas.end());
  double total = 0.0;
  for (const double a : areas) total += a;
  return total;
}

}  // namespace

// + 0.0 turns -0 into +0.
double snap(double value, double grid_m) { return std::round(value / grid_m) / std::round(1.0 / grid_m) + 0.0; }

Region2 unite(std::span<const Polygon2> polygons) { return canonical(joined(polygons)); }

Region2 subtract(const Region2& region, std::span<const Polygon2> polygons) {
  ExactSet set = exact(region);
  set.difference(joined(polygons));
  return canonical(set);
}

Region2 intersect(const Region2& a, const Region2& b) { return canonical(common(exact(a), exact(b))); }

double area(const Region2& region) {
  double total = 0.0;
  for (const PolygonWithHoles2& piece : region) {
    total += signed_area(piece.outer);
    for (const Polygon2& hole : piece.holes) total += signed_area(hole);
  }
  return total;
}

bool contains(const PolygonWithHoles2& polygon, const Eigen::Vector2d& p) {
  return contains(polygon.outer, polygon.holes, p);
}

double intersection_area(const Polygon2& a, const Polygon2& b) {
  if (!is_simple(a) || !is_simple(b)) throw InternalError("intersection area of a polygon that is not simple");
  return exact_area(common(ExactSet(counter_clockwise(a)), ExactSet(counter_clockwise(b))));
}

}  // namespace plumbline
