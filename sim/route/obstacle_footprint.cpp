// SPDX-License-Identifier: Apache-2.0
#include "sim/route/obstacle_footprint.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "bim/mesh/solid.h"
#include "bim/model/hull.h"
#include "bim/model/through.h"
#include "bim/model/wall_frame.h"

namespace plumbline::sim {

namespace {

/// Heights between which elements are obstacles, W.
struct Band {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] bool meets(double z0, double z1) const { return z1 > low && z0 < high; }
};

/// Shares of the band at which solids are cut to find their inside.
constexpr std::array<double, 4> section_shares = {0.02, 0.3, 0.6, 0.98};

using Polygon3 = std::vector<Eigen::Vector3d>;

/// Part of a convex polygon with sign * z <= sign * limit.
Polygon3 clip_z(const Polygon3& polygon, double sign, double limit) {
  Polygon3 kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a.z() - limit);
    const double db = sign * (b.z() - limit);
    if (da <= 0.0) kept.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

void add_ring(const Polygon2& ring, std::vector<Segment2>& segments) {
  for (std::size_t i = 0; i < ring.size(); ++i) segments.push_back({ring[i], ring[(i + 1) % ring.size()]});
}

ObstacleFootprint from_polygon(const PolygonWithHoles2& polygon) {
  ObstacleFootprint footprint;
  add_ring(polygon.outer, footprint.edges);
  for (const Polygon2& hole : polygon.holes) add_ring(hole, footprint.edges);
  footprint.sections.push_back(footprint.edges);
  return footprint;
}

/// Where a triangle meets the height z, if it crosses it.
std::optional<Segment2> cut_triangle(const std::array<Eigen::Vector3d, 3>& t, double z) {
  std::vector<Eigen::Vector2d> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& a = t[k];
    const Eigen::Vector3d& b = t[(k + 1) % 3];
    if ((a.z() > z) == (b.z() > z)) continue;
    ends.emplace_back((a + (b - a) * ((z - a.z()) / (b.z() - a.z()))).head<2>());
  }
  if (ends.size() != 2) return std::nullopt;
  return Segment2{ends[0], ends[1]};
}

/// A closed surface with outward normals has a solid inside; of others (a room as a shell, a wall without thickness)
/// only the surface is an obstacle.
bool has_inside(const bim::Solid& solid, double weld_m) {
  const bim::Solid joined = bim::welded(solid, weld_m);
  return bim::is_closed(joined) && bim::volume(joined) > 0.0;
}

ObstacleFootprint from_solid(const bim::Solid& solid, const Band& band, double weld_m) {
  ObstacleFootprint footprint;
  if (has_inside(solid, weld_m)) footprint.sections.resize(section_shares.size());
  for (const Eigen::Vector3i& triangle : solid.triangles) {
    std::array<Eigen::Vector3d, 3> t;
    for (int k = 0; k < 3; ++k)
      t[static_cast<std::size_t>(k)] = solid.vertices.at(static_cast<std::size_t>(triangle[k]));
    Polygon2 seen;
    for (const Eigen::Vector3d& p : clip_z(clip_z({t.begin(), t.end()}, -1.0, band.low), 1.0, band.high))
      seen.emplace_back(p.head<2>());
    add_ring(seen, footprint.edges);
    for (std::size_t i = 0; i < footprint.sections.size(); ++i)
      if (const auto cut = cut_triangle(t, band.low + section_shares[i] * (band.high - band.low)))
        footprint.sections[i].push_back(*cut);
  }
  return footprint;
}

/// An opening that ends this far before a face of its wall is cut through it.
constexpr double past_m = 0.05;

std::vector<Gap> passable_gaps(const bim::Building& building, int wall_index, double floor_z,
                               const RouteConfig& config) {
  const bim::Wall& wall = building.walls[static_cast<std::size_t>(wall_index)];
  std::vector<Gap> gaps;
  for (const bim::Opening& opening : building.openings) {
    if (opening.wall != wall_index || opening.kind == bim::OpeningKind::window) continue;
    if (opening.kind == bim::OpeningKind::door && opening.leaf == bim::Leaf::closed) continue;
    if (opening.z0_m > floor_z + config.sill_max_m || opening.z1_m < floor_z + config.head_min_m) continue;
    if (!bim::goes_through(opening, wall)) continue;
    Gap gap{wall.a, wall.direction(), opening.s_m - 0.5 * opening.width_m, opening.s_m + 0.5 * opening.width_m};
    // Seen from above, as the edges are, also where the wall leans.
    Interval own;
    for (const bim::Solid& solid : bim::solids_of(opening))
      for (const Eigen::Vector3d& p : solid.vertices) own.add(gap.left().dot(p.head<2>() - gap.a));
    if (own.length() > 0.0) gap.across = {own.low - past_m, own.high + past_m};
    gaps.push_back(gap);
  }
  return gaps;
}

/// Parts of a segment outside a gap.
void cut_segment(const Segment2& segment, const Gap& gap, std::vector<Segment2>& parts) {
  const Eigen::Vector2d left = gap.left();
  const double sa = gap.e.dot(segment.a - gap.a), sb = gap.e.dot(segment.b - gap.a);
  const double ta = left.dot(segment.a - gap.a), tb = left.dot(segment.b - gap.a);
  double from = 0.0, to = 1.0;  // shares of the segment between which it is in the gap
  const auto limit = [&](double a, double b, double low, double high) {
    if (std::max(a, b) <= low || std::min(a, b) >= high) to = -1.0;
    if (a == b) return;
    const double at_low = (low - a) / (b - a), at_high = (high - a) / (b - a);
    from = std::max(from, std::min(at_low, at_high));
    to = std::min(to, std::max(at_low, at_high));
  };
  limit(sa, sb, gap.s0, gap.s1);
  limit(ta, tb, gap.across.low, gap.across.high);
  if (from >= to) {
    parts.push_back(segment);
    return;
  }
  const auto at = [&](double share) -> Eigen::Vector2d { return segment.a + (segment.b - segment.a) * share; };
  // In the direction of the wall.
  if (sa < sb) {
    if (from > 0.0) parts.push_back({segment.a, at(from)});
    if (to < 1.0) parts.push_back({at(to), segment.b});
  } else {
    if (to < 1.0) parts.push_back({segment.b, at(to)});
    if (from > 0.0) parts.push_back({at(from), segment.a});
  }
}

/// Cuts a gap out of a wall's edges and adds its two reveals.
void cut_gap(const Gap& gap, ObstacleFootprint& footprint) {
  const Eigen::Vector2d left = gap.left();
  std::optional<double> low;
  std::optional<double> high;
  std::vector<Segment2> parts;
  for (const Segment2& edge : footprint.edges) {
    const std::size_t before = parts.size();
    cut_segment(edge, gap, parts);
    if (parts.size() == before + 1 && parts.back().a == edge.a && parts.back().b == edge.b) continue;
    for (const Eigen::Vector2d& p : {edge.a, edge.b}) {
      const double across = std::clamp(left.dot(p - gap.a), gap.across.low, gap.across.high);
      low = low ? std::min(*low, across) : across;
      high = high ? std::max(*high, across) : across;
    }
  }
  footprint.edges = std::move(parts);
  footprint.gaps.push_back(gap);
  if (!low) return;
  for (const double s : {gap.s0, gap.s1})
    footprint.edges.push_back({gap.a + s * gap.e + *low * left, gap.a + s * gap.e + *high * left});
}

ObstacleFootprint wall_footprint(const bim::Building& building, int index, double floor_z, const Band& band,
                                 const RouteConfig& config) {
  const bim::Wall& wall = building.walls[static_cast<std::size_t>(index)];
  ObstacleFootprint footprint;
  if (wall.body) {
    footprint = from_solid(*wall.body, band, config.weld_m);
  } else {
    const Eigen::Vector2d near = wall.offset_m * wall.left();
    const Eigen::Vector2d far = (wall.offset_m + wall.thickness_m) * wall.left();
    footprint = from_polygon({{wall.a + near, wall.b + near, wall.b + far, wall.a + far}, {}});
  }
  for (const Gap& gap : passable_gaps(building, index, floor_z, config)) cut_gap(gap, footprint);
  return footprint;
}

}  // namespace

std::vector<Polygon2> hollow_obstacles(const bim::Building& building, double floor_z, const RouteConfig& config) {
  const Band band{floor_z + config.band_low_m, floor_z + config.band_high_m};
  std::vector<Polygon2> hulls;
  for (const bim::Obstacle& obstacle : building.obstacles) {
    Polygon2 corners;
    double z0 = band.high, z1 = band.low;
    for (const Eigen::Vector3d& p : obstacle.body.vertices) {
      corners.emplace_back(p.head<2>());
      z0 = std::min(z0, p.z());
      z1 = std::max(z1, p.z());
    }
    if (!band.meets(z0, z1)) continue;
    Polygon2 hull = bim::convex_hull(std::move(corners));
    if (hull.empty() || signed_area(hull) > config.furniture_max_m2 || has_inside(obstacle.body, config.weld_m))
      continue;
    hulls.push_back(std::move(hull));
  }
  return hulls;
}

std::vector<ObstacleFootprint> find_obstacle_footprints(const bim::Building& building, double floor_z,
                                                        const RouteConfig& config) {
  const Band band{floor_z + config.band_low_m, floor_z + config.band_high_m};
  std::vector<ObstacleFootprint> result;
  const auto add = [&](ObstacleFootprint footprint, const std::string& kind, const std::string& id) {
    footprint.name = kind + " '" + id + "'";
    result.push_back(std::move(footprint));
  };
  const auto of = [&](const auto& element, const PolygonWithHoles2& outline) {
    return element.body ? from_solid(*element.body, band, config.weld_m) : from_polygon(outline);
  };
  for (std::size_t i = 0; i < building.walls.size(); ++i)
    if (const bim::Wall& wall = building.walls[i]; band.meets(wall.z0_m, wall.z1_m))
      add(wall_footprint(building, static_cast<int>(i), floor_z, band, config), "wall", wall.id);
  for (const bim::Slab& slab : building.slabs)
    if (band.meets(slab.z0_m, slab.z1_m)) add(of(slab, slab.polygon), "slab", slab.id);
  for (const bim::Column& column : building.columns)
    if (band.meets(column.z0_m, column.z1_m)) add(of(column, {column.footprint, {}}), "column", column.id);
  for (const bim::Stair& stair : building.stairs)
    for (const bim::Solid& body : stair.bodies)
      if (ObstacleFootprint footprint = from_solid(body, band, config.weld_m); !footprint.edges.empty())
        add(std::move(footprint), "stair", stair.id);
  for (const bim::Obstacle& obstacle : building.obstacles)
    if (ObstacleFootprint footprint = from_solid(obstacle.body, band, config.weld_m); !footprint.edges.empty())
      add(std::move(footprint), obstacle.kind, obstacle.id);
  return result;
}

}  // namespace plumbline::sim
