// SPDX-License-Identifier: Apache-2.0
#include "bim/model/steep_floors.h"

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/model/floors.h"

namespace plumbline::bim {

namespace {

constexpr double steepest_named = 1.0;  ///< tangent
constexpr double at_ground_m = 0.3;     ///< a robot climbs 0.2 m, and the end of a ramp may be rounded off; assumed

bool may_slope(const Building& building) {
  return std::any_of(building.slabs.begin(), building.slabs.end(), [](const Slab& slab) { return slab.body; }) ||
         std::any_of(building.obstacles.begin(), building.obstacles.end(),
                     [](const Obstacle& obstacle) { return obstacle.kind == "ramp"; });
}

std::string name_of(const Building& building, const FloorPiece& piece) {
  const auto element = static_cast<std::size_t>(piece.element);
  return piece.source == FloorSource::slab
             ? "slab '" + building.slabs[element].id + "'"
             : building.obstacles[element].kind + " '" + building.obstacles[element].id + "'";
}

}  // namespace

std::vector<SteepFloor> steep_floors(const Building& as_built, int storey, double ground_m,
                                     const WalkedFloorConfig& config) {
  std::vector<SteepFloor> steep;
  if (!may_slope(as_built)) return steep;
  FloorConfig floors;
  floors.steepest = steepest_named;
  for (const FloorPiece& piece : floor_pieces(as_built, floors)) {
    const double slope = piece.slope.norm();
    if (piece.storey != storey || slope <= config.steepest) continue;
    double low = piece.z_at(piece.polygon.outer.front()), high = low;
    for (const Eigen::Vector2d& p : piece.polygon.outer) {
      low = std::min(low, piece.z_at(p));
      high = std::max(high, piece.z_at(p));
    }
    if (low > ground_m + at_ground_m || high < ground_m - at_ground_m) continue;
    steep.push_back({name_of(as_built, piece), piece.polygon, slope});
  }
  return steep;
}

std::string too_steep_text(const SteepFloor& floor, const WalkedFloorConfig& config) {
  // Rounded up, so that 20.4 % is not said to be 20 %.
  const auto percent = [](double tangent) { return format_number(std::ceil(100.0 * tangent - 1e-6)) + " %"; };
  return floor.name + " rises by " + percent(floor.slope) + ", and the robot walks up to " + percent(config.steepest);
}

}  // namespace plumbline::bim
