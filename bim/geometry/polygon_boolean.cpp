// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon_boolean.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "bim/errors.h"

namespace plumbline {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPolygon = CGAL::Polygon_2<Kernel>;
using ExactPiece = CGAL::Polygon_with_holes_2<Kernel>;
using ExactSet = CGAL::Polygon_set_2<Kernel>;

bool before(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

bool ring_before(const Polygon2& a, const Polygon2& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
}

Polygon2 snapped(const Polygon2& polygon) {
  Polygon2 ring;
  for (const Eigen::Vector2d& p : polygon) {
    const Eigen::Vector2d q(snap(p.x()), snap(p.y()));
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

ExactPiece exact(const PolygonWithHoles2& piece) {
  ExactPiece result(counter_clockwise(piece.outer));
  for (const Polygon2& hole : piece.holes) {
    ExactPolygon ring = counter_clockwise(hole);
    ring.reverse_orientation();
    result.add_hole(ring);
  }
  return result;
}

ExactSet exact(const Region2& region) {
  ExactSet set;
  for (const PolygonWithHoles2& piece : region) set.join(exact(piece));
  return set;
}

ExactSet joined(std::span<const Polygon2> polygons) {
  std::vector<ExactPolygon> rings;
  for (const Polygon2& polygon : polygons) {
    const Polygon2 ring = snapped(polygon);
    if (is_simple(ring)) rings.push_back(counter_clockwise(ring));
  }
  ExactSet set;
  set.join(rings.begin(), rings.end());
  return set;
}

/// Grid steps are whole numbers, so that "on one line" can be decided without rounding.
bool on_one_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto steps = [](double v) { return std::llround(v / boolean_grid_m); };
  const auto ux = steps(b.x()) - steps(a.x()), uy = steps(b.y()) - steps(a.y());
  const auto vx = steps(c.x()) - steps(b.x()), vy = steps(c.y()) - steps(b.y());
  return ux * vy == uy * vx;
}

/// Ring on the grid, without straight vertices, starting at its smallest vertex; empty when nothing is left.
Polygon2 canonical_ring(const ExactPolygon& polygon) {
  Polygon2 ring;
  for (const Kernel::Point_2& p : polygon.container())
    ring.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()));
  ring = snapped(ring);
  for (bool changed = true; changed && ring.size() >= 3;) {
    changed = false;
    for (std::size_t i = 0; i < ring.size() && ring.size() >= 3; ++i) {
      const std::size_t n = ring.size();
      if (!on_one_line(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n])) continue;
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  if (ring.size() < 3) return {};
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), before), ring.end());
  return ring;
}

Region2 canonical(const ExactSet& set) {
  std::vector<ExactPiece> pieces;
  set.polygons_with_holes(std::back_inserter(pieces));
  Region2 region;
  for (const ExactPiece& piece : pieces) {
    PolygonWithHoles2 result{canonical_ring(piece.outer_boundary()), {}};
    if (result.outer.empty()) continue;
    for (auto hole = piece.holes_begin(); hole != piece.holes_end(); ++hole) {
      Polygon2 ring = canonical_ring(*hole);
      if (!ring.empty()) result.holes.push_back(std::move(ring));
    }
    std::sort(result.holes.begin(), result.holes.end(), ring_before);
    region.push_back(std::move(result));
  }
  std::sort(region.begin(), region.end(),
            [](const PolygonWithHoles2& a, const PolygonWithHoles2& b) { return ring_before(a.outer, b.outer); });
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

double snap(double value, double grid_m) { return std::round(value / grid_m) * grid_m; }

Region2 unite(std::span<const Polygon2> polygons) { return canonical(joined(polygons)); }

Region2 subtract(const Region2& region, std::span<const Polygon2> polygons) {
  ExactSet set = exact(region);
  set.difference(joined(polygons));
  return canonical(set);
}

Region2 intersect(const Region2& a, const Region2& b) {
  ExactSet set = exact(a);
  set.intersection(exact(b));
  return canonical(set);
}

double area(const Region2& region) {
  double total = 0.0;
  for (const PolygonWithHoles2& piece : region) {
    total += signed_area(piece.outer);
    for (const Polygon2& hole : piece.holes) total += signed_area(hole);
  }
  return total;
}

bool contains(const PolygonWithHoles2& polygon, const Eigen::Vector2d& p) {
  if (!contains(polygon.outer, p)) return false;
  return std::none_of(polygon.holes.begin(), polygon.holes.end(),
                      [&](const Polygon2& hole) { return contains(hole, p) && boundary_distance(hole, p) > 1e-9; });
}

double intersection_area(const Polygon2& a, const Polygon2& b) {
  if (!is_simple(a) || !is_simple(b)) throw InternalError("intersection area of a polygon that is not simple");
  ExactSet set(counter_clockwise(a));
  set.intersection(ExactSet(counter_clockwise(b)));
  return exact_area(set);
}

}  // namespace plumbline
