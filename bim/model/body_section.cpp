// SPDX-License-Identifier: Apache-2.0
#include "bim/model/body_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

}  // namespace

Region2 body_section(const Solid& body, double z_m) {
  std::vector<Polygon2> rings = rings_of(edges_at(body, z_m));
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
