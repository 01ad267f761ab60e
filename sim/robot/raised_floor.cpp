// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/raised_floor.h"

#include <algorithm>
#include <cmath>

#include "bim/model/floors.h"

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

}  // namespace

std::vector<RaisedFloor> raised_floors(const bim::Building& as_built, int storey, const RaisedFloorConfig& config) {
  const double elevation = as_built.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  const auto is_raised = [&](double z) { return z > elevation + config.level_m && z <= elevation + config.highest_m; };
  // Looking for floors costs more than the rest; most buildings have nothing between the levels of their storeys.
  const bool any = std::any_of(as_built.slabs.begin(), as_built.slabs.end(),
                               [&](const bim::Slab& slab) { return is_raised(slab.z1_m); }) ||
                   std::any_of(as_built.rooms.begin(), as_built.rooms.end(),
                               [&](const bim::Room& room) { return room.storey == storey && is_raised(room.z0_m); });
  if (!any) return {};
  std::vector<RaisedFloor> floors;
  for (const bim::FloorPiece& piece : bim::floor_pieces(as_built))
    if (piece.storey == storey && piece.slope.isZero(0.0) && is_raised(piece.z0_m))
      floors.push_back({piece.polygon, piece.z0_m});
  const std::size_t count = floors.size();
  for (const bim::Opening& opening : as_built.openings) {
    if (opening.wall < 0 || opening.kind == bim::OpeningKind::window || !is_raised(opening.z0_m)) continue;
    const Polygon2 outline = threshold(opening, as_built.walls[static_cast<std::size_t>(opening.wall)]);
    const bool leads =
        std::any_of(floors.begin(), floors.begin() + static_cast<std::ptrdiff_t>(count), [&](const RaisedFloor& floor) {
          return std::abs(floor.z_W - opening.z0_m) <= config.doorway_m &&
                 is_beside(outline, floor.polygon, config.beside_m);
        });
    if (leads) floors.push_back({{outline, {}}, opening.z0_m});
  }
  std::stable_sort(floors.begin(), floors.end(),
                   [](const RaisedFloor& a, const RaisedFloor& b) { return a.z_W < b.z_W; });
  return floors;
}

}  // namespace plumbline::sim
