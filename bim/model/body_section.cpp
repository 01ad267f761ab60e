// SPDX-License-Identifier: Apache-2.0
#include "bim/model/body_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

constexpr double touching_m = 1e-4;

struct SectionEdge {
  Eigen::Vector2d a, b;  ///< material on the left
};

std::vector<SectionEdge> edges_at(const Solid& body, double z) {
  std::vector<SectionEdge> edges;
  for (const Eigen::Vector3i& triangle : body.triangles) {
    const auto corner = [&](int k) -> const Eigen::Vector3d& {
      return body.vertices[static_cast<std::size_t>(triangle[k % 3])];
    };
    std::vector<Eigen::Vector2d> ends;
    for (int k = 0; k < 3; ++k) {
      // From below, so that both triangles of a side find the same point.
      Eigen::Vector3d low = corner(k), high = corner(k + 1);
      if ((low.z() > z) == (high.z() > z)) continue;
      if (low.z() > high.z()) std::swap(low, high);
      ends.emplace_back((low + (high - low) * ((z - low.z()) / (high.z() - low.z()))).head<2>());
    }
    if (ends.size() != 2) continue;
    const Eigen::Vector2d out = (corner(1) - corner(0)).cross(corner(2) - corner(0)).head<2>();
    const Eigen::Vector2d along = ends[1] - ends[0];
    if (along.x() * out.y() - along.y() * out.x() > 0.0) std::swap(ends[0], ends[1]);
    edges.push_back({ends[0], ends[1]});
  }
  return edges;
}

/// Edges shorter than `touching_m` would hide what goes on behind them.
std::vector<Polygon2> rings_of(std::vector<SectionEdge> edges) {
  std::erase_if(edges, [](const SectionEdge& edge) { return (edge.b - edge.a).norm() < 0.5 * touching_m; });
  std::vector<Polygon2> rings;
  std::vector<bool> taken(edges.size(), false);
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (taken[first]) continue;
    Polygon2 ring;
    std::size_t at = first;
    bool closed = false;
    while (!closed) {
      taken[at] = true;
      ring.push_back(edges[at].a);
      const Eigen::Vector2d end = edges[at].b;
      if (ring.size() >= 3 && (edges[first].a - end).norm() <= touching_m) {
        closed = true;
        break;
      }
      double nearest = touching_m;
      std::size_t next = edges.size();
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const double away = (edges[i].a - end).norm();
        if (taken[i] || away > nearest || (next < edges.size() && away >= nearest)) continue;
        nearest = away;
        next = i;
      }
      if (next == edges.size()) break;
      at = next;
    }
    if (closed) rings.push_back(std::move(ring));
  }
  return rings;
}

using Step = std::pair<double, double>;  ///< a point in steps of the grid of the booleans

Polygon2 in_steps_of_grid(const Polygon2& ring) {
  Polygon2 steps;
  for (const Eigen::Vector2d& p : ring) {
    const Eigen::Vector2d q = (p / boolean_grid_m).array().round();
    if (steps.empty() || steps.back() != q) steps.push_back(q);
  }
  while (steps.size() > 1 && steps.back() == steps.front()) steps.pop_back();
  return steps;
}

/// What the booleans would leave out: it passes a point twice or runs back along itself.
bool touches_itself(const Polygon2& ring) {
  const Polygon2 steps = in_steps_of_grid(ring);
  return steps.size() >= 3 && !is_simple(steps);
}

/// Edges from point to point, cut where another one ends on them. Two that run against each other, as along the seam of
/// a ring, bound nothing.
std::map<Step, std::vector<Step>> bounding_edges(const std::vector<SectionEdge>& edges) {
  std::vector<Polygon2> ends;
  std::vector<Eigen::Vector2d> corners;
  for (const SectionEdge& edge : edges) {
    ends.push_back(in_steps_of_grid({edge.a, edge.b}));
    corners.insert(corners.end(), ends.back().begin(), ends.back().end());
  }
  const auto before = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return Step(p.x(), p.y()) < Step(q.x(), q.y());
  };
  std::sort(corners.begin(), corners.end(), before);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::map<std::pair<Step, Step>, int> times;  // less those the other way
  for (const Polygon2& edge : ends) {
    if (edge.size() < 2) continue;
    const Eigen::Vector2d e = (edge[1] - edge[0]).normalized();
    std::vector<std::pair<double, Step>> points;
    for (const Eigen::Vector2d& p : corners) {
      const Eigen::Vector2d d = p - edge[0];
      const double along = e.dot(d), across = e.x() * d.y() - e.y() * d.x();
      if (along >= 0.0 && e.dot(edge[1] - p) >= 0.0 && std::abs(across) <= 1.0)
        points.emplace_back(along, Step(p.x(), p.y()));
    }
    std::sort(points.begin(), points.end());
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto &p = points[i].second, &q = points[i + 1].second;
      times[std::minmax(p, q)] += p < q ? 1 : -1;
    }
  }
  std::map<Step, std::vector<Step>> next;
  for (const auto& [edge, sum] : times)
    if (sum != 0) next[sum > 0 ? edge.first : edge.second].push_back(sum > 0 ? edge.second : edge.first);
  return next;
}

/// The same edges as rings that pass no point twice: one that would is two.
std::vector<Polygon2> rings_apart(const std::vector<SectionEdge>& edges) {
  std::map<Step, std::vector<Step>> next = bounding_edges(edges);
  const auto to_left = [](const Step& from, const Step& at, const Step& to) {
    const Eigen::Vector2d d(at.first - from.first, at.second - from.second),
        e(to.first - at.first, to.second - at.second);
    return std::atan2(d.x() * e.y() - d.y() * e.x(), d.dot(e));
  };
  std::vector<Polygon2> rings;
  for (auto& [start, unused] : next) {
    std::vector<Step> path = {start};
    while (!path.empty()) {
      std::vector<Step>& ends = next[path.back()];
      if (ends.empty()) {
        path.pop_back();
        continue;
      }
      // Sharpest to the left, so that parts that meet in a corner stay parts.
      auto chosen = ends.begin();
      for (auto end = ends.begin(); path.size() > 1 && end != ends.end(); ++end)
        if (to_left(path[path.size() - 2], path.back(), *end) > to_left(path[path.size() - 2], path.back(), *chosen))
          chosen = end;
      const Step end = *chosen;
      ends.erase(chosen);
      const auto loop = std::find(path.begin(), path.end(), end);
      if (loop == path.end()) {
        path.push_back(end);
        continue;
      }
      Polygon2& ring = rings.emplace_back();
      for (auto p = loop; p != path.end(); ++p)
        ring.emplace_back(snap(p->first * boolean_grid_m), snap(p->second * boolean_grid_m));
      path.erase(loop + 1, path.end());
    }
  }
  return rings;
}

}  // namespace

Region2 body_section(const Solid& body, double z_m) {
  const std::vector<SectionEdge> edges = edges_at(body, z_m);
  std::vector<Polygon2> rings = rings_of(edges);
  if (std::any_of(rings.begin(), rings.end(), touches_itself)) rings = rings_apart(edges);
  double sum = 0.0;
  for (const Polygon2& ring : rings) sum += signed_area(ring);
  const double outward = sum < 0.0 ? -1.0 : 1.0;  // of a body whose faces are turned over all rings run backwards
  std::stable_sort(rings.begin(), rings.end(), [](const Polygon2& p, const Polygon2& q) {
    return std::abs(signed_area(p)) > std::abs(signed_area(q));
  });
  Region2 region;
  std::vector<Polygon2> parts, holes;
  const auto take = [&] {
    if (!parts.empty()) {
      for (const PolygonWithHoles2& piece : unite(parts)) region.push_back(piece);
      parts.clear();
    }
    if (!holes.empty()) region = subtract(region, holes);
    holes.clear();
  };
  for (Polygon2& ring : rings) {
    const bool part = outward * signed_area(ring) > 0.0;
    if (part && !holes.empty()) take();
    (part ? parts : holes).push_back(std::move(ring));
  }
  take();
  return region;
}

Region2 wall_section(const Wall& wall, double z_m) {
  if (wall.body)
    if (Region2 region = body_section(*wall.body, z_m); !region.empty()) return region;
  return unite(std::vector<Polygon2>{footprint(wall)});
}

double fill_of(const Wall& wall) {
  const double rectangle = wall.length() * wall.thickness_m;
  if (!wall.body || rectangle <= 0.0) return 1.0;
  double most = 0.0;
  for (const double share : {0.1, 0.5, 0.9})
    most = std::max(most, area(wall_section(wall, wall.z0_m + share * (wall.z1_m - wall.z0_m))));
  return most / rectangle;
}

}  // namespace plumbline::bim
