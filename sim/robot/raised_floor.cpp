// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/raised_floor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::sim {

namespace {

/// The stretch of its wall that an opening leaves.
Polygon2 threshold(const bim::Opening& opening, const bim::Wall& wall) {
  const Eigen::Vector2d e = wall.direction(), near = wall.offset_m * wall.left(),
                        far = (wall.offset_m + wall.thickness_m) * wall.left();
  const Eigen::Vector2d a = wall.a + (opening.s_m - 0.5 * opening.width_m) * e,
                        b = wall.a + (opening.s_m + 0.5 * opening.width_m) * e;
  return {a + near, b + near, b + far, a + far};
}

bool is_beside(const Polygon2& outline, const PolygonWithHoles2& floor, double distance_m) {
  return std::any_of(outline.begin(), outline.end(), [&](const Eigen::Vector2d& p) {
    return contains(floor.outer, p) || boundary_distance(floor.outer, p) <= distance_m;
  });
}

/// Lowest and highest point of a piece.
std::pair<double, double> heights_of(const bim::FloorPiece& piece) {
  std::pair<double, double> z{piece.z_at(piece.polygon.outer.front()), piece.z_at(piece.polygon.outer.front())};
  for (const Eigen::Vector2d& p : piece.polygon.outer) {
    z.first = std::min(z.first, piece.z_at(p));
    z.second = std::max(z.second, piece.z_at(p));
  }
  return z;
}

/// A slab's top this far below a storey is the floor of a room: the room begins there, or no covering is so thick.
bool is_sunken(double z, double elevation, const bim::Room& room, const RaisedFloorConfig& config) {
  if (z >= elevation - config.level_m || z < elevation - config.lowest_m) return false;
  return std::abs(room.z0_m - z) <= config.level_m || z < room.z0_m - config.bare_slab_m;
}

/// Looking for floors costs more than the rest; most buildings have nothing below the levels of their storeys.
bool may_be_sunken(const bim::Building& building, int storey, double elevation, const RaisedFloorConfig& config) {
  return std::any_of(building.rooms.begin(), building.rooms.end(), [&](const bim::Room& room) {
    return room.storey == storey &&
           std::any_of(building.slabs.begin(), building.slabs.end(), [&](const bim::Slab& slab) {
             return !slab.assumed && is_sunken(slab.z1_m, elevation, room, config);
           });
  });
}

/// The lowest level slab of a room, or the storey's elevation.
double ground_of(const bim::Building& building, int storey, const std::vector<bim::FloorPiece>& pieces,
                 const RaisedFloorConfig& config) {
  const double elevation = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  double ground = elevation;
  for (const bim::FloorPiece& piece : pieces) {
    if (piece.storey != storey || piece.source != bim::FloorSource::slab || !piece.slope.isZero(0.0)) continue;
    if (piece.z0_m >= ground || area({piece.polygon}) < config.sunken_min_m2) continue;
    // One slab may lie under several rooms, and several may lie in one room.
    const Eigen::Vector2d p = interior_point(piece.polygon.outer);
    const bool in_room = std::any_of(building.rooms.begin(), building.rooms.end(), [&](const bim::Room& room) {
      return room.storey == storey && is_sunken(piece.z0_m, elevation, room, config) &&
             (contains(room.polygon, p) || contains(piece.polygon.outer, interior_point(room.polygon)));
    });
    if (in_room) ground = piece.z0_m;
  }
  return ground;
}

bool is_ramp(const bim::Building& building, const bim::FloorPiece& piece) {
  return piece.source == bim::FloorSource::obstacle &&
         building.obstacles[static_cast<std::size_t>(piece.element)].kind == "ramp";
}

/// Adds the thresholds of open doors that lead to one of the floors.
void add_thresholds(const bim::Building& building, const std::function<bool(double)>& is_raised,
                    const RaisedFloorConfig& config, std::vector<RaisedFloor>& floors) {
  const std::size_t count = floors.size();
  for (const bim::Opening& opening : building.openings) {
    if (opening.wall < 0 || opening.kind == bim::OpeningKind::window || !is_raised(opening.z0_m)) continue;
    const Polygon2 outline = threshold(opening, building.walls[static_cast<std::size_t>(opening.wall)]);
    const bool leads =
        std::any_of(floors.begin(), floors.begin() + static_cast<std::ptrdiff_t>(count), [&](const RaisedFloor& floor) {
          return is_beside(outline, floor.polygon, config.beside_m) &&
                 std::any_of(outline.begin(), outline.end(), [&](const Eigen::Vector2d& p) {
                   return std::abs(floor.z_at(p) - opening.z0_m) <= config.doorway_m;
                 });
        });
    if (leads) floors.push_back({{outline, {}}, opening.z0_m, opening.z0_m});
  }
}

}  // namespace

WalkedFloors walked_floors(const bim::Building& as_built, int storey, const RaisedFloorConfig& config) {
  const double elevation = as_built.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  WalkedFloors floors{elevation, {}};
  const auto is_raised = [&](double z) {
    return z > floors.ground_W + config.level_m && z <= elevation + config.highest_m;
  };
  // Looking for floors costs more than the rest; most buildings have nothing between the levels of their storeys.
  const bool sunken = may_be_sunken(as_built, storey, elevation, config);
  const bool any = sunken ||
                   std::any_of(as_built.slabs.begin(), as_built.slabs.end(),
                               [&](const bim::Slab& slab) { return is_raised(slab.z1_m); }) ||
                   std::any_of(as_built.rooms.begin(), as_built.rooms.end(),
                               [&](const bim::Room& room) { return room.storey == storey && is_raised(room.z0_m); }) ||
                   std::any_of(as_built.obstacles.begin(), as_built.obstacles.end(),
                               [](const bim::Obstacle& obstacle) { return obstacle.kind == "ramp"; });
  if (!any) return floors;
  const std::vector<bim::FloorPiece> pieces = bim::floor_pieces(as_built);
  if (sunken) floors.ground_W = ground_of(as_built, storey, pieces, config);
  for (const bim::FloorPiece& piece : pieces) {
    if (piece.storey != storey) continue;
    const auto [low, high] = heights_of(piece);
    const bool slopes = !piece.slope.isZero(0.0);
    if (slopes && (piece.slope.norm() > config.steepest || high - low < config.slope_min_m)) continue;
    if (!is_raised(high) || low < floors.ground_W - config.level_m) continue;
    floors.raised.push_back(
        {piece.polygon, high, piece.z0_m, piece.slope, is_ramp(as_built, piece) ? piece.element : -1});
  }
  add_thresholds(as_built, is_raised, config, floors.raised);
  std::stable_sort(floors.raised.begin(), floors.raised.end(),
                   [](const RaisedFloor& a, const RaisedFloor& b) { return a.z_W < b.z_W; });
  return floors;
}

}  // namespace plumbline::sim
