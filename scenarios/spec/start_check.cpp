// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/start_check.h"

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/model/body_section.h"
#include "bim/model/stair_flight.h"
#include "bim/model/through.h"

namespace plumbline::scenarios {

namespace {

/// In the plane, openings included. Of a bent wall the body counts, not the rectangle around it.
bool in_body(const bim::Wall& wall, const Eigen::Vector2d& p) {
  const double along = (p - wall.a).dot(wall.direction());
  const double across = (p - wall.a).dot(wall.left());
  if (along < 0.0 || along > wall.length() || across < wall.offset_m || across > wall.offset_m + wall.thickness_m)
    return false;
  if (!wall.body) return true;
  const Region2 section = bim::wall_section(wall, 0.5 * (wall.z0_m + wall.z1_m));
  return std::any_of(section.begin(), section.end(), [&](const auto& piece) { return contains(piece, p); });
}

/// Where in the plane a stair stands.
bool on_stair(const bim::Stair& stair, const Eigen::Vector2d& p) {
  return std::any_of(stair.flights.begin(), stair.flights.end(),
                     [&](const bim::StairFlight& f) {
                       return f.steps > 0 && contains(bim::steps_outline(f, 0, f.steps - 1), p);
                     }) ||
         std::any_of(stair.landings.begin(), stair.landings.end(),
                     [&](const bim::Landing& landing) { return contains(landing.polygon, p); });
}

/// Where a point given in map coordinates lies in a building that was moved to the origin; empty for other points.
std::string moved_text(const bim::Building& building, const Eigen::Vector2d& at) {
  if (!building.moved_by) return "";
  const Eigen::Vector2d moved = at + building.moved_by->head<2>();
  if (moved.norm() >= at.norm()) return "";
  return "; the file's coordinates are those of a map and were moved: on the map's " + point_text(at) + " lies " +
         point_text(moved);
}

}  // namespace

bool on_a_stair(const bim::Building& building, int storey, const Eigen::Vector2d& p_W) {
  return std::any_of(building.stairs.begin(), building.stairs.end(), [&](const bim::Stair& stair) {
    return (stair.from == storey || stair.to == storey) && on_stair(stair, p_W);
  });
}

bool in_a_doorway(const bim::Building& building, int storey, const Eigen::Vector2d& p_W) {
  return std::any_of(building.openings.begin(), building.openings.end(), [&](const bim::Opening& opening) {
    if (opening.wall < 0 || opening.kind == bim::OpeningKind::window || opening.leaf == bim::Leaf::closed) return false;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    if (!bim::goes_through(opening, wall)) return false;
    const double along = (p_W - wall.a).dot(wall.direction());
    return wall.storey == storey && in_body(wall, p_W) && std::abs(along - opening.s_m) <= 0.5 * opening.width_m;
  });
}

void check_start(const sim::MultiStoreyPlanner& space, int storey, const Eigen::Vector2d& at, const Mark& mark) {
  const bim::Building& building = space.building();
  const std::string start = "the start " + point_text(at);
  const bool doorway = in_a_doorway(building, storey, at);
  for (const bim::Wall& wall : building.walls)
    if (!doorway && wall.storey == storey && in_body(wall, at))
      throw InputError(mark, start + " is inside a wall ('" + wall.id + "'); it must be in a room");
  for (const bim::Stair& stair : building.stairs)
    if ((stair.from == storey || stair.to == storey) && on_stair(stair, at))
      throw InputError(mark, start + " is on stair '" + stair.id + "'; it must be on the floor of a storey");
  const auto in_room = [&](const bim::Room& r) { return r.storey == storey && r.contains(at); };
  const bool has_rooms =
      std::any_of(building.rooms.begin(), building.rooms.end(), [&](const bim::Room& r) { return r.storey == storey; });
  if (has_rooms && !doorway && std::none_of(building.rooms.begin(), building.rooms.end(), in_room))
    throw InputError(mark, start + " is outside every room; it must be in a room" + moved_text(building, at));
  const sim::ClearanceMap& floor = space.storey(storey);
  if (const auto cell = floor.grid().find(at); !cell || !floor.has_floor(*cell))
    throw InputError(mark, start + " is not on the floor: no slab lies there near the height of its storey, " +
                               format_number(building.storeys[static_cast<std::size_t>(storey)].elevation_m) + " m" +
                               moved_text(building, at));
  if (!floor.free(at))
    throw InputError(mark, start + " is in or too near to a wall or another thing (" +
                               format_number(std::round(floor.clearance(at) * 1e4) / 1e4) +
                               " m clear); the robot needs more room around it");
}

std::string point_text(const Eigen::Vector2d& p) {
  return "[" + format_number(p.x()) + ", " + format_number(p.y()) + "]";
}

}  // namespace plumbline::scenarios
