// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/snap_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "bim/errors.h"

namespace plumbline {

namespace {

/// Whole numbers, so that turns are decided without rounding; in regions of up to 2^29 steps, or 50 km.
using Vertex = Eigen::Matrix<std::int64_t, 2, 1>;
using Loop = std::vector<Vertex>;

/// An edge before it is rounded.
struct Edge {
  Eigen::Vector2d a, b;
};

struct RoundEdge {
  Vertex a, b;
};

bool before(const Vertex& p, const Vertex& q) { return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y(); }

struct Before {
  bool operator()(const Vertex& p, const Vertex& q) const { return before(p, q); }
};

/// Pixels are half open, so that each point lies in one.
Vertex rounded(const Eigen::Vector2d& p) {
  return {static_cast<std::int64_t>(std::floor(p.x() + 0.5)), static_cast<std::int64_t>(std::floor(p.y() + 0.5))};
}

std::int64_t cross(const Vertex& u, const Vertex& v) { return u.x() * v.y() - u.y() * v.x(); }

int turn(const Vertex& a, const Vertex& b, const Vertex& c) {
  const std::int64_t t = cross(b - a, c - b);
  return (t > 0) - (t < 0);
}

/// The edge has a point within half a step of the vertex, along both axes.
bool meets_pixel(const Edge& edge, const Vertex& v) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = static_cast<double>(v[axis]) - 0.5, high = low + 1.0, p = edge.a[axis], d = edge.b[axis] - p;
    if (d == 0.0) {
      if (p < low || p >= high) return false;
      continue;
    }
    const double s = (low - p) / d, t = (high - p) / d;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  if (from < to) return true;
  if (from > to) return false;
  return rounded(edge.a + from * (edge.b - edge.a)) == v;
}

/// How often each edge runs from its smaller end to the other, less how often it runs back; never 0.
using Edges = std::map<std::array<std::int64_t, 4>, int>;

void add(Edges& edges, const Vertex& a, const Vertex& b) {
  const bool forward = before(a, b);
  const Vertex &p = forward ? a : b, &q = forward ? b : a;
  const auto place = edges.try_emplace({p.x(), p.y(), q.x(), q.y()}, 0).first;
  place->second += forward ? 1 : -1;
  if (place->second == 0) edges.erase(place);
}

/// The edges led through all vertices that they come near; those that fall together and run against each other vanish.
std::vector<RoundEdge> led_through(const std::vector<Edge>& edges, const std::vector<Vertex>& vertices) {
  Edges led;
  for (const Edge& edge : edges) {
    const Vertex a = rounded(edge.a), b = rounded(edge.b);
    const Vertex low = a.cwiseMin(b), high = a.cwiseMax(b);
    const Eigen::Vector2d d = edge.b - edge.a;
    std::vector<std::pair<double, Vertex>> met;
    for (auto v = std::lower_bound(vertices.begin(), vertices.end(), low, before);
         v != vertices.end() && v->x() <= high.x(); ++v) {
      if (v->y() < low.y() || v->y() > high.y() || *v == a || *v == b || !meets_pixel(edge, *v)) continue;
      met.emplace_back((v->cast<double>() - edge.a).dot(d), *v);
    }
    std::sort(met.begin(), met.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    Vertex from = a;
    for (const auto& [at, v] : met) {
      add(led, from, v);
      from = v;
    }
    if (from != b) add(led, from, b);
  }
  std::vector<RoundEdge> result;
  for (const auto& [ends, count] : led) {
    const Vertex p(ends[0], ends[1]), q(ends[2], ends[3]);
    for (int i = 0; i < std::abs(count); ++i) result.push_back(count > 0 ? RoundEdge{p, q} : RoundEdge{q, p});
  }
  return result;
}

/// Where two edges cross, neither at an end of both; nullopt where they do not.
std::optional<Vertex> crossing(const RoundEdge& e, const RoundEdge& f) {
  const int a = turn(e.a, e.b, f.a), b = turn(e.a, e.b, f.b), c = turn(f.a, f.b, e.a), d = turn(f.a, f.b, e.b);
  if (a * b >= 0 || c * d >= 0) return std::nullopt;
  const Eigen::Vector2d p = e.a.cast<double>(), u = (e.b - e.a).cast<double>(), v = (f.b - f.a).cast<double>();
  const Eigen::Vector2d w = (f.a - e.a).cast<double>();
  return rounded(p + (w.x() * v.y() - w.y() * v.x()) / (u.x() * v.y() - u.y() * v.x()) * u);
}

/// The vertex lies on the edge, between its ends.
bool lies_within(const Vertex& v, const RoundEdge& e) {
  return turn(e.a, e.b, v) == 0 && (v - e.a).dot(e.b - e.a) > 0 && (v - e.b).dot(e.a - e.b) > 0;
}

/// Calls `take` with each pair of edges that have an x in common.
template <class Take>
void each_pair(std::vector<RoundEdge> edges, const Take& take) {
  const auto low = [](const RoundEdge& e) { return std::min(e.a.x(), e.b.x()); };
  std::sort(edges.begin(), edges.end(), [&](const RoundEdge& e, const RoundEdge& f) { return low(e) < low(f); });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::int64_t end = std::max(edges[i].a.x(), edges[i].b.x());
    for (std::size_t k = i + 1; k < edges.size() && low(edges[k]) <= end; ++k) take(edges[i], edges[k]);
  }
}

std::vector<Vertex> crossings(const std::vector<RoundEdge>& edges) {
  std::vector<Vertex> found;
  each_pair(edges, [&](const RoundEdge& e, const RoundEdge& f) {
    if (const std::optional<Vertex> v = crossing(e, f)) found.push_back(*v);
  });
  return found;
}

/// Edges meet at their ends alone.
bool only_ends_meet(const std::vector<RoundEdge>& edges) {
  bool meet = false;
  each_pair(edges, [&](const RoundEdge& e, const RoundEdge& f) {
    meet = meet || (e.a == f.a && e.b == f.b) || lies_within(e.a, f) || lies_within(e.b, f) || lies_within(f.a, e) ||
           lies_within(f.b, e) || crossing(e, f);
  });
  return !meet;
}

void sort_unique(std::vector<Vertex>& vertices) {
  std::sort(vertices.begin(), vertices.end(), before);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

std::vector<Edge> edges_of(const std::vector<Polygon2>& rings) {
  std::vector<Edge> edges;
  for (const Polygon2& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  return edges;
}

/// Rounded edges that do not cross.
std::vector<RoundEdge> arranged(std::vector<Edge> edges) {
  std::vector<Vertex> vertices;
  for (const Edge& edge : edges) vertices.push_back(rounded(edge.a));
  // Once is enough but where coordinates hit the rim of a pixel to within the rounding of a double.
  constexpr int most_rounds = 10;
  for (int round = 0; round < most_rounds; ++round) {
    sort_unique(vertices);
    std::vector<RoundEdge> led = led_through(edges, vertices);
    const std::vector<Vertex> crossed = crossings(led);
    if (crossed.empty()) return led;
    vertices.insert(vertices.end(), crossed.begin(), crossed.end());
    edges.clear();
    for (const RoundEdge& e : led) edges.push_back({e.a.cast<double>(), e.b.cast<double>()});
  }
  throw InternalError("edges of a region cross after rounding");
}

/// Half plane of a direction, then its angle: 0 for angles from 0 to pi.
bool lower_half(const Vertex& d) { return d.y() < 0 || (d.y() == 0 && d.x() < 0); }

/// Counter-clockwise order of directions from the x axis.
bool angle_before(const Vertex& u, const Vertex& v) {
  return lower_half(u) != lower_half(v) ? lower_half(v) : cross(u, v) > 0;
}

/// Of the edges that leave a vertex, the one that bounds the same wedge of the area as the one that comes from `from`.
std::size_t next_around(const std::vector<RoundEdge>& edges, const std::vector<std::size_t>& leaving,
                        const Vertex& back) {
  // Clockwise from the way back: the last one before it, or the last of all.
  std::size_t best = leaving.front(), last = leaving.front();
  bool found = false;
  for (const std::size_t i : leaving) {
    const Vertex d = edges[i].b - edges[i].a;
    if (angle_before(edges[last].b - edges[last].a, d)) last = i;
    if (!angle_before(d, back)) continue;
    if (!found || angle_before(edges[best].b - edges[best].a, d)) best = i;
    found = true;
  }
  return found ? best : last;
}

/// Closed loops around each connected piece of the area; one may pass a vertex several times. Nullopt where the edges
/// around a vertex do not come and leave in turn: then lines cross there.
std::optional<std::vector<Loop>> traced(const std::vector<RoundEdge>& edges) {
  std::map<Vertex, std::vector<std::size_t>, Before> leaving;
  for (std::size_t i = 0; i < edges.size(); ++i) leaving[edges[i].a].push_back(i);
  std::vector<char> taken(edges.size(), 0);
  std::vector<Loop> loops;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (taken[first] != 0) continue;
    Loop& loop = loops.emplace_back();
    for (std::size_t at = first;;) {
      taken[at] = 1;
      loop.push_back(edges[at].a);
      std::vector<std::size_t>& out = leaving[edges[at].b];
      const std::size_t next = next_around(edges, out, edges[at].a - edges[at].b);
      if (next == first) break;
      if (taken[next] != 0) return std::nullopt;
      at = next;
    }
  }
  return loops;
}

/// Loops of a loop that touches itself in single vertices.
std::vector<Loop> split_at_touching_vertices(const Loop& ring) {
  std::vector<Loop> loops;
  Loop open;
  for (const Vertex& p : ring) {
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

/// Twice the area, positive when counter-clockwise.
std::int64_t twice_area(const Loop& loop) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) sum += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  return sum;
}

/// Whether a point lies in the loop, both in half steps; it lies on none of the loop's edges.
bool encloses(const Loop& loop, const Vertex& twice_p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vertex a = 2 * loop[i] - twice_p, b = 2 * loop[(i + 1) % loop.size()] - twice_p;
    if ((a.y() > 0) != (b.y() > 0) && (cross(a, b) > 0) == (b.y() > 0)) inside = !inside;
  }
  return inside;
}

/// Without straight vertices, from its smallest vertex on.
Polygon2 canonical(Loop loop) {
  for (bool changed = true; changed && loop.size() >= 3;) {
    changed = false;
    for (std::size_t i = 0; i < loop.size() && loop.size() >= 3; ++i) {
      const std::size_t n = loop.size();
      if (turn(loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]) != 0) continue;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
    }
  }
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), before), loop.end());
  Polygon2 ring;
  for (const Vertex& p : loop) ring.push_back(p.cast<double>());
  return ring;
}

bool ring_before(const Polygon2& a, const Polygon2& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
                                        return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
                                      });
}

/// Simple loops with an area on their left; nullopt where lines cross in a vertex.
std::optional<std::vector<Loop>> loops_of(const std::vector<RoundEdge>& edges) {
  const std::optional<std::vector<Loop>> traces = traced(edges);
  if (!traces) return std::nullopt;
  std::vector<Loop> loops;
  for (const Loop& loop : *traces)
    for (Loop& part : split_at_touching_vertices(loop))
      if (twice_area(part) != 0) loops.push_back(std::move(part));
  return loops;
}

/// Outlines lie outside of others or in a hole, and holes in an outline.
bool nested(const std::vector<Loop>& loops) {
  return std::all_of(loops.begin(), loops.end(), [&](const Loop& loop) {
    int around = 0;
    for (const Loop& other : loops)
      if (&other != &loop && encloses(other, loop[0] + loop[1])) around += twice_area(other) > 0 ? 1 : -1;
    return around == (twice_area(loop) > 0 ? 0 : 1);
  });
}

/// Rounded vertex by vertex, which moves least, where that leaves everything in its place; snap rounded otherwise.
std::vector<Loop> rounded_loops(const std::vector<Edge>& edges) {
  const std::vector<RoundEdge> plain = led_through(edges, {});
  if (only_ends_meet(plain))
    if (std::optional<std::vector<Loop>> loops = loops_of(plain); loops && nested(*loops)) return *loops;
  std::optional<std::vector<Loop>> loops = loops_of(arranged(edges));
  if (!loops) throw InternalError("lines of a region cross in a vertex after rounding");
  return *loops;
}

}  // namespace

std::vector<PolygonWithHoles2> snap_rounded(const std::vector<Polygon2>& rings) {
  std::vector<Loop> outlines, holes;
  for (Loop& loop : rounded_loops(edges_of(rings)))
    (twice_area(loop) > 0 ? outlines : holes).push_back(std::move(loop));
  std::stable_sort(outlines.begin(), outlines.end(),
                   [](const Loop& p, const Loop& q) { return twice_area(p) < twice_area(q); });
  std::vector<PolygonWithHoles2> pieces;
  for (const Loop& outline : outlines) pieces.push_back({canonical(outline), {}});
  for (const Loop& hole : holes) {
    // The middle of an edge lies on no other edge, and the smallest outline around it is the hole's.
    const Vertex twice_p = hole[0] + hole[1];
    const auto owner =
        std::find_if(outlines.begin(), outlines.end(), [&](const Loop& outline) { return encloses(outline, twice_p); });
    if (owner == outlines.end()) throw InternalError("a hole of a region lies outside of it");
    pieces[static_cast<std::size_t>(owner - outlines.begin())].holes.push_back(canonical(hole));
  }
  for (PolygonWithHoles2& piece : pieces) std::sort(piece.holes.begin(), piece.holes.end(), ring_before);
  std::sort(pieces.begin(), pieces.end(),
            [](const PolygonWithHoles2& a, const PolygonWithHoles2& b) { return ring_before(a.outer, b.outer); });
  return pieces;
}

void lead_through_corners(std::vector<PolygonWithHoles2>& pieces) {
  std::vector<Vertex> corners;
  const auto each = [&](const auto& take) {
    for (PolygonWithHoles2& piece : pieces) {
      take(piece.outer);
      for (Polygon2& hole : piece.holes) take(hole);
    }
  };
  each([&](const Polygon2& ring) {
    for (const Eigen::Vector2d& p : ring) corners.push_back(rounded(p));
  });
  sort_unique(corners);
  each([&](Polygon2& ring) {
    Polygon2 led;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vertex a = rounded(ring[i]), b = rounded(ring[(i + 1) % ring.size()]);
      const std::int64_t low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
      std::vector<std::pair<std::int64_t, Vertex>> within;
      for (auto v = std::lower_bound(corners.begin(), corners.end(), std::min(a, b, before), before);
           v != corners.end() && v->x() <= std::max(a.x(), b.x()); ++v)
        if (v->y() >= low && v->y() <= high && *v != a && *v != b && turn(a, b, *v) == 0)
          within.emplace_back((*v - a).dot(b - a), *v);
      std::sort(within.begin(), within.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
      led.push_back(ring[i]);
      for (const auto& [along, v] : within) led.push_back(v.cast<double>());
    }
    ring = std::move(led);
  });
}

}  // namespace plumbline
