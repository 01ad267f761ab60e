// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon_boolean.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_set_2.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

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

ExactSet exact(const Region2& region) {
  std::vector<ExactPiece> pieces;
  for (const PolygonWithHoles2& piece : region) {
    pieces.emplace_back(counter_clockwise(piece.outer));
    for (const Polygon2& hole : piece.holes) pieces.back().add_hole(clockwise(hole));
  }
  return joined(pieces);
}

ExactSet joined(std::span<const Polygon2> polygons) {
  std::vector<ExactPiece> pieces;
  for (const Polygon2& polygon : polygons) {
    const Polygon2 ring = snapped(polygon);
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

/// Grid steps are whole numbers, so that "on one line" can be decided without rounding.
bool on_one_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto steps = [](double v) { return std::llround(v / boolean_grid_m); };
  const auto ux = steps(b.x()) - steps(a.x()), uy = steps(b.y()) - steps(a.y());
  const auto vx = steps(c.x()) - steps(b.x()), vy = steps(c.y()) - steps(b.y());
  return ux * vy == uy * vx;
}

/// Loops of a ring that touches itself in single vertices.
std::vector<Polygon2> split_at_touching_vertices(const Polygon2& ring) {
  std::vector<Polygon2> loops;
  Polygon2 open;
  for (const Eigen::Vector2d& p : ring) {
    const auto seen = std::find(open.begin(), open.end(), p);
    if (seen != open.end()) {
      loops.emplace_back(seen, open.end());
      open.erase(seen, open.end());
    }
    open.push_back(p);
  }
  loops.push_back(std::move(open));
  return loops;
}

/// Loop without straight vertices, starting at its smallest vertex; empty when nothing is left.
Polygon2 canonical_loop(Polygon2 loop) {
  for (bool changed = true; changed && loop.size() >= 3;) {
    changed = false;
    for (std::size_t i = 0; i < loop.size() && loop.size() >= 3; ++i) {
      const std::size_t n = loop.size();
      if (!on_one_line(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n])) continue;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  if (loop.size() < 3) return {};
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), before), loop.end());
  return loop;
}

/// Rounding may move a vertex onto or over an edge. Such an edge is led through the vertex, where the ring can be
/// split.
Polygon2 led_through_near_vertices(const Polygon2& ring) {
  Polygon2 led;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    std::vector<std::pair<double, std::size_t>> on_edge;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const double s = (ring[k] - a).dot(b - a) / (b - a).squaredNorm();
      if (s > 0.0 && s < 1.0 && ring[k] != a && ring[k] != b && segment_distance(a, b, ring[k]) <= boolean_grid_m)
        on_edge.emplace_back(s, k);
    }
    std::sort(on_edge.begin(), on_edge.end());
    led.push_back(a);
    for (const auto& [s, k] : on_edge) led.push_back(ring[k]);
  }
  return led;
}

std::vector<Polygon2> canonical_loops(const ExactPolygon& polygon) {
  Polygon2 ring;
  for (const Kernel::Point_2& p : polygon.container())
    ring.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()));
  std::vector<Polygon2> loops;
  for (Polygon2& loop : split_at_touching_vertices(snapped(ring))) {
    Polygon2 result = canonical_loop(std::move(loop));
    if (result.empty()) continue;
    if (is_simple(result)) {
      loops.push_back(std::move(result));
      continue;
    }
    for (Polygon2& part : split_at_touching_vertices(led_through_near_vertices(result)))
      if (Polygon2 simple = canonical_loop(std::move(part)); !simple.empty() && is_simple(simple))
        loops.push_back(std::move(simple));
  }
  return loops;
}

bool piece_before(const PolygonWithHoles2& a, const PolygonWithHoles2& b) { return ring_before(a.outer, b.outer); }

bool encloses(const Polygon2& outer, const Polygon2& hole) {
  return std::all_of(hole.begin(), hole.end(), [&](const Eigen::Vector2d& p) { return contains(outer, p); });
}

/// Pieces of one connected result: loops that turn left are outlines, those that turn right holes.
Region2 pieces_of(const ExactPiece& piece) {
  std::vector<Polygon2> loops = canonical_loops(piece.outer_boundary());
  for (auto hole = piece.holes_begin(); hole != piece.holes_end(); ++hole)
    for (Polygon2& loop : canonical_loops(*hole)) loops.push_back(std::move(loop));
  std::sort(loops.begin(), loops.end(), ring_before);
  Region2 pieces;
  for (const Polygon2& loop : loops)
    if (signed_area(loop) > 0.0) pieces.push_back({loop, {}});
  for (Polygon2& loop : loops) {
    if (signed_area(loop) > 0.0) continue;
    const auto owner =
        std::find_if(pieces.begin(), pieces.end(), [&](const PolygonWithHoles2& p) { return encloses(p.outer, loop); });
    if (owner != pieces.end()) owner->holes.push_back(std::move(loop));
  }
  return pieces;
}

Region2 canonical(const ExactSet& set) {
  std::vector<ExactPiece> exact_pieces;
  set.polygons_with_holes(std::back_inserter(exact_pieces));
  Region2 region;
  for (const ExactPiece& piece : exact_pieces)
    for (PolygonWithHoles2& part : pieces_of(piece)) region.push_back(std::move(part));
  std::sort(region.begin(), region.end(), piece_before);
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
  if (!contains(polygon.outer, p)) return false;
  return std::none_of(polygon.holes.begin(), polygon.holes.end(),
                      [&](const Polygon2& hole) { return contains(hole, p) && boundary_distance(hole, p) > 1e-9; });
}

double intersection_area(const Polygon2& a, const Polygon2& b) {
  if (!is_simple(a) || !is_simple(b)) throw InternalError("intersection area of a polygon that is not simple");
  return exact_area(common(ExactSet(counter_clockwise(a)), ExactSet(counter_clockwise(b))));
}

}  // namespace plumbline
