// SPDX-License-Identifier: Apache-2.0
#include "bim/model/walked_floors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/geometry/interval.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/through.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

/// The stretch of its wall that an opening leaves.
Polygon2 threshold(const Opening& opening, const Wall& wall) {
  const Interval depth = depth_in_wall(opening, wall);
  const Eigen::Vector2d e = wall.direction(), near = depth.low * wall.left(), far = depth.high * wall.left();
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
std::pair<double, double> heights_of(const FloorPiece& piece) {
  std::pair<double, double> z{piece.z_at(piece.polygon.outer.front()), piece.z_at(piece.polygon.outer.front())};
  for (const Eigen::Vector2d& p : piece.polygon.outer) {
    z.first = std::min(z.first, piece.z_at(p));
    z.second = std::max(z.second, piece.z_at(p));
  }
  return z;
}

/// A slab's top this far below a storey is the floor of a room: the room begins there, or no covering is so thick.
bool is_sunken(double z, double elevation, const Room& room, const WalkedFloorConfig& config) {
  if (z >= elevation - config.level_m || z < elevation - config.lowest_m) return false;
  return std::abs(room.z0_m - z) <= config.level_m || z < room.z0_m - config.bare_slab_m;
}

/// Looking for floors costs more than the rest; most buildings have nothing below the levels of their storeys.
bool may_be_sunken(const Building& building, int storey, double elevation, const WalkedFloorConfig& config) {
  return std::any_of(building.rooms.begin(), building.rooms.end(), [&](const Room& room) {
    return room.storey == storey && std::any_of(building.slabs.begin(), building.slabs.end(), [&](const Slab& slab) {
             return !slab.assumed && is_sunken(slab.z1_m, elevation, room, config);
           });
  });
}

/// The lowest level slab of a room, or the storey's elevation.
double ground_of(const Building& building, int storey, const std::vector<FloorPiece>& pieces,
                 const WalkedFloorConfig& config) {
  const double elevation = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  double ground = elevation;
  for (const FloorPiece& piece : pieces) {
    if (piece.storey != storey || piece.source != FloorSource::slab || !piece.slope.isZero(0.0)) continue;
    if (piece.z0_m >= ground || area({piece.polygon}) < config.sunken_min_m2) continue;
    // One slab may lie under several rooms, and several may lie in one room.
    const Eigen::Vector2d p = interior_point(piece.polygon.outer);
    const bool in_room = std::any_of(building.rooms.begin(), building.rooms.end(), [&](const Room& room) {
      return room.storey == storey && is_sunken(piece.z0_m, elevation, room, config) &&
             (room.contains(p) || contains(piece.polygon.outer, interior_point(room.polygon)));
    });
    if (in_room) ground = piece.z0_m;
  }
  return ground;
}

/// The ramp or the floor covering that a piece is the top of. A footing is an obstacle all the same.
int walked_obstacle(const Building& building, const FloorPiece& piece) {
  if (piece.source != FloorSource::obstacle) return -1;
  return building.obstacles[static_cast<std::size_t>(piece.element)].kind == "footing" ? -1 : piece.element;
}

/// Adds the thresholds of open doors that lead to one of the floors.
void add_thresholds(const Building& building, const Interval& heights, const WalkedFloorConfig& config,
                    std::vector<RaisedFloor>& floors) {
  const std::size_t count = floors.size();
  for (const Opening& opening : building.openings) {
    if (opening.wall < 0 || opening.kind == OpeningKind::window || opening.z0_m <= heights.low ||
        opening.z0_m > heights.high)
      continue;
    const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    if (!goes_through(opening, wall)) continue;
    const Polygon2 outline = threshold(opening, wall);
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

double height_at(const WalkedFloors& floors, const Eigen::Vector2d& p) {
  double height = floors.ground_m;
  for (const RaisedFloor& floor : floors.raised)
    if (contains(floor.polygon, p)) height = std::max(height, floor.z_at(p));
  return height;
}

WalkedFloors moved(const Pose& X_VW, WalkedFloors floors) {
  const auto move = [&](Polygon2& polygon) {
    for (Eigen::Vector2d& p : polygon) p = (X_VW * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>();
  };
  const double rise = X_VW.t.z();
  floors.ground_m += rise;
  for (RaisedFloor& floor : floors.raised) {
    move(floor.polygon.outer);
    for (Polygon2& hole : floor.polygon.holes) move(hole);
    floor.slope = (X_VW.q * Eigen::Vector3d(floor.slope.x(), floor.slope.y(), 0.0)).head<2>();
    floor.z_m += rise;
    floor.z0_m += rise - floor.slope.dot(X_VW.t.head<2>());
  }
  return floors;
}

WalkedFloors walked_floors(const Building& as_built, int storey, const WalkedFloorConfig& config) {
  const double elevation = as_built.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  WalkedFloors floors{elevation, {}};
  const auto is_raised = [&](double z) {
    return z > floors.ground_m + config.level_m && z <= elevation + config.highest_m;
  };
  // Looking for floors costs more than the rest; most buildings have nothing between the levels of their storeys.
  const bool sunken = may_be_sunken(as_built, storey, elevation, config);
  const bool any = sunken ||
                   std::any_of(as_built.slabs.begin(), as_built.slabs.end(),
                               [&](const Slab& slab) { return is_raised(slab.z1_m); }) ||
                   std::any_of(as_built.rooms.begin(), as_built.rooms.end(),
                               [&](const Room& room) { return room.storey == storey && is_raised(room.z0_m); }) ||
                   std::any_of(as_built.obstacles.begin(), as_built.obstacles.end(), [&](const Obstacle& obstacle) {
                     return obstacle.kind == "ramp" || is_floor_covering(as_built, obstacle);
                   });
  if (!any) return floors;
  const std::vector<FloorPiece> pieces = floor_pieces(as_built);
  if (sunken) floors.ground_m = ground_of(as_built, storey, pieces, config);
  for (const FloorPiece& piece : pieces) {
    if (piece.storey != storey) continue;
    const auto [low, high] = heights_of(piece);
    const bool slopes = !piece.slope.isZero(0.0);
    if (slopes && (piece.slope.norm() > config.steepest || high - low < config.slope_min_m)) continue;
    const int obstacle = walked_obstacle(as_built, piece);
    const bool covers = obstacle >= 0 && !slopes && high > floors.ground_m && high <= elevation + config.highest_m;
    if ((!is_raised(high) && !covers) || low < floors.ground_m - config.level_m) continue;
    floors.raised.push_back({piece.polygon, high, piece.z0_m, piece.slope, obstacle});
  }
  add_thresholds(as_built, {floors.ground_m, elevation + config.highest_m}, config, floors.raised);
  std::stable_sort(floors.raised.begin(), floors.raised.end(),
                   [](const RaisedFloor& a, const RaisedFloor& b) { return a.z_m < b.z_m; });
  return floors;
}

}  // namespace plumbline::bim
