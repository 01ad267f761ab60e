// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/surroundings.h"

#include <algorithm>
#include <cmath>

#include "bim/model/boxes.h"
#include "bim/model/hull.h"
#include "bim/model/stair_flight.h"
#include "bim/model/through.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

using Box3 = Eigen::AlignedBox3d;

Box3 bounds_of(const Wall& wall) {
  Box3 box;
  if (wall.body) box.extend(box_of(*wall.body));
  if (wall.body) return box;
  for (const Eigen::Vector2d& p : footprint(wall))
    for (const double z : {wall.z0_m, wall.z1_m}) box.extend(Eigen::Vector3d(p.x(), p.y(), z));
  return box;
}

Box3 bounds_of(const Column& column) {
  Box3 box;
  if (column.body) box.extend(box_of(*column.body));
  if (column.body) return box;
  for (const Eigen::Vector2d& p : column.footprint)
    for (const double z : {column.z0_m, column.z1_m}) box.extend(Eigen::Vector3d(p.x(), p.y(), z));
  return box;
}

Box3 bounds_of(const Stair& stair) {
  Box3 box;
  for (const Solid& solid : stair.bodies) box.extend(box_of(solid));
  for (const StairFlight& flight : stair.flights)
    for (const Eigen::Vector2d& p : steps_outline(flight, 0, flight.steps - 1))
      for (const int step : {0, flight.steps})
        box.extend(Eigen::Vector3d(p.x(), p.y(), flight.z0_m + step * flight.rise_m));
  return box;
}

void add_if_any(Footprint found, std::vector<Footprint>& all) {
  if (!found.parts.empty()) all.push_back(std::move(found));
}

void add_hull(const Polygon2& points, std::vector<Footprint>& all) {
  Polygon2 hull = convex_hull(points);
  if (hull.size() >= 3) all.push_back(footprint_of(std::move(hull)));
}

/// A stair covers the floor that it starts from, and leaves a hole in the one it leads to.
void add_stair(const Stair& stair, std::vector<Footprint>& all) {
  for (const StairFlight& flight : stair.flights)
    if (flight.steps > 0) all.push_back(footprint_of(steps_outline(flight, 0, flight.steps - 1)));
  for (const Landing& landing : stair.landings) add_hull(landing.polygon, all);
}

bool overlaps(const Eigen::AlignedBox2d& box, double z0, double z1, const Box3& other) {
  const Eigen::AlignedBox2d flat(other.min().head<2>(), other.max().head<2>());
  return !other.isEmpty() && other.min().z() < z1 && other.max().z() > z0 && flat.intersects(box);
}

/// A rectangle that begins at p and goes `deep` along the direction, `half` to either side.
Polygon2 ahead(const Eigen::Vector2d& p, const Eigen::Vector2d& along, double deep, double half) {
  const Eigen::Vector2d left(-along.y(), along.x());
  return {p - half * left, p + deep * along - half * left, p + deep * along + half * left, p + half * left};
}

void add_door(const Building& building, const Opening& opening, double floor_z_m, const WalkableConfig& config,
              std::vector<Polygon2>& areas) {
  constexpr double head_min_m = 1.2;
  if (opening.kind == OpeningKind::window || opening.wall < 0 || opening.width_m < config.passage_min_m) return;
  if (std::abs(opening.z0_m - floor_z_m) > config.sill_max_m || opening.z1_m < floor_z_m + head_min_m) return;
  const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
  if (!(wall.length() > 0.0) || !goes_through(opening, wall)) return;
  const Eigen::Vector2d middle = wall.a + opening.s_m * wall.direction();
  const double half = 0.5 * opening.width_m + config.door_beside_m;
  areas.push_back(
      ahead(middle, wall.left(), std::max(0.0, wall.offset_m + wall.thickness_m) + config.door_deep_m, half));
  areas.push_back(ahead(middle, -wall.left(), std::max(0.0, -wall.offset_m) + config.door_deep_m, half));
}

void add_stair_ends(const Stair& stair, double floor_z_m, const WalkableConfig& config, std::vector<Polygon2>& areas) {
  constexpr double level_m = 0.3;
  for (const StairFlight& flight : stair.flights) {
    const double half = 0.5 * flight.width_m + config.stair_beside_m;
    const double head_z = flight.z0_m + flight.steps * flight.rise_m;
    if (std::abs(flight.z0_m - floor_z_m) < level_m)
      areas.push_back(ahead(flight.start, -ascent(flight), config.stair_deep_m, half));
    if (std::abs(head_z - floor_z_m) < level_m)
      areas.push_back(ahead(head_of(flight, 0.0), ascent(flight), config.stair_deep_m, half));
  }
}

}  // namespace

Surroundings::Surroundings(const Building& building) : building_(building) {
  for (const Wall& wall : building.walls) walls_.push_back(bounds_of(wall));
  for (const Column& column : building.columns) columns_.push_back(bounds_of(column));
  for (const Stair& stair : building.stairs) stairs_.push_back(bounds_of(stair));
  for (const Slab& slab : building.slabs) {
    slabs_.emplace_back();
    if (slab.body) slabs_.back().extend(box_of(*slab.body));
  }
  for (const Obstacle& obstacle : building.obstacles) {
    obstacles_.emplace_back();
    obstacles_.back().extend(box_of(obstacle.body));
  }
}

std::vector<Footprint> Surroundings::near(const Eigen::AlignedBox2d& box, double floor_z_m,
                                          const std::vector<int>& without, const WalkableConfig& config) const {
  const double z0 = floor_z_m + config.band_low_m, z1 = floor_z_m + config.band_high_m;
  std::vector<Footprint> all;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    const Wall& wall = building_.walls[i];
    if (!overlaps(box, z0, z1, walls_[i])) continue;
    add_if_any(wall.body ? footprint_of(*wall.body, z0, z1) : footprint_of(footprint(wall)), all);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = building_.columns[i];
    if (!overlaps(box, z0, z1, columns_[i])) continue;
    if (column.body)
      add_if_any(footprint_of(*column.body, z0, z1), all);
    else
      add_hull(column.footprint, all);
  }
  for (std::size_t i = 0; i < stairs_.size(); ++i) {
    // At its head a stair ends level with the floor; its hole is below.
    if (!overlaps(box, floor_z_m - config.sill_max_m, z1, stairs_[i])) continue;
    add_stair(building_.stairs[i], all);
    for (const Solid& solid : building_.stairs[i].bodies) add_if_any(footprint_of(solid, z0, z1), all);
  }
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    if (!std::binary_search(without.begin(), without.end(), static_cast<int>(i)) &&
        overlaps(box, z0, z1, obstacles_[i]))
      add_if_any(footprint_of(building_.obstacles[i].body, z0, z1), all);
  // The floor itself may lie a little higher; a roof comes down.
  for (std::size_t i = 0; i < slabs_.size(); ++i)
    if (overlaps(box, floor_z_m + config.sill_max_m, z1, slabs_[i]))
      add_if_any(footprint_of(*building_.slabs[i].body, floor_z_m + config.sill_max_m, z1), all);
  for (const Slab& slab : building_.slabs)
    if (std::abs(slab.z1_m - floor_z_m) < config.sill_max_m)
      for (const Polygon2& hole : slab.polygon.holes) add_hull(hole, all);
  std::erase_if(all, [&](const Footprint& footprint) { return !footprint.box.intersects(box); });
  return all;
}

std::vector<Polygon2> keep_clear(const Building& building, const Room& room, double floor_z_m,
                                 const WalkableConfig& config) {
  constexpr double open_half_m = 0.6;
  std::vector<Polygon2> areas;
  for (const Opening& opening : building.openings) add_door(building, opening, floor_z_m, config, areas);
  for (const Stair& stair : building.stairs) add_stair_ends(stair, floor_z_m, config, areas);
  for (const VirtualEdge& edge : room.virtual_edges) {
    const Eigen::Vector2d along = edge.b - edge.a;
    if (along.norm() < 2.0 * config.radius_m) continue;
    // The outline is counter-clockwise, so the room lies to its left.
    const Eigen::Vector2d in = Eigen::Vector2d(-along.y(), along.x()).normalized();
    areas.push_back(ahead(0.5 * (edge.a + edge.b), in, config.door_deep_m, std::min(open_half_m, 0.5 * along.norm())));
  }
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  std::erase_if(areas, [&](const Polygon2& area) { return !footprint_of(area).box.intersects(box); });
  return areas;
}

}  // namespace plumbline::bim
