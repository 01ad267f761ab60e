// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/storey_kinds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline::bim {
namespace {

/// The box of a storey's rooms and what stands at them; empty without any.
Eigen::AlignedBox2d box_of_rooms(const Building& building, int storey, const StoreyKindConfig& config) {
  Eigen::AlignedBox2d box;
  for (const Room& room : building.rooms)
    if (room.storey == storey)
      for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  if (!box.isEmpty()) box = {box.min().array() - config.beside_m, box.max().array() + config.beside_m};
  return box;
}

/// What stands around a storey's rooms may hang on another one.
bool has_upright(const Building& building, int storey, const StoreyKindConfig& config) {
  const double floor_m = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  const auto stands = [&](const auto& element) {
    return element.z0_m <= floor_m + config.knee_m && element.z1_m >= floor_m + config.person_m;
  };
  const auto stands_here = [&](const auto& element) { return element.storey == storey && stands(element); };
  const Eigen::AlignedBox2d rooms = box_of_rooms(building, storey, config);
  return std::any_of(building.walls.begin(), building.walls.end(), stands_here) ||
         std::any_of(building.columns.begin(), building.columns.end(), stands_here) ||
         std::any_of(
             building.walls.begin(), building.walls.end(),
             [&](const Wall& wall) { return stands(wall) && (rooms.contains(wall.a) || rooms.contains(wall.b)); }) ||
         std::any_of(building.obstacles.begin(), building.obstacles.end(), [&](const Obstacle& obstacle) {
           return obstacle.storey == storey && obstacle.kind == "curtain_panel";
         });
}

bool has_floor(const Building& building, int storey, const StoreyKindConfig& config) {
  const double floor_m = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  return has_room(building, storey) || std::any_of(building.slabs.begin(), building.slabs.end(), [&](const Slab& slab) {
           return std::abs(slab.z1_m - floor_m) <= config.floor_m && signed_area(slab.polygon.outer) >= config.least_m2;
         });
}

}  // namespace

bool has_room(const Building& building, int storey) {
  return std::any_of(building.rooms.begin(), building.rooms.end(),
                     [&](const Room& room) { return room.storey == storey; });
}

bool has_door(const Building& building, int storey, const StoreyKindConfig& config) {
  const double floor_m = building.storeys[static_cast<std::size_t>(storey)].elevation_m;
  return std::any_of(building.openings.begin(), building.openings.end(), [&](const Opening& opening) {
    return opening.kind == OpeningKind::door && opening.wall >= 0 &&
           building.walls[static_cast<std::size_t>(opening.wall)].storey == storey &&
           std::abs(opening.z0_m - floor_m) <= config.floor_m;
  });
}

void set_storey_kinds(Building& building, const StoreyKindConfig& config) {
  const std::size_t n = building.storeys.size();
  std::vector<bool> upright(n), habitable(n);
  for (std::size_t i = 0; i < n; ++i) {
    upright[i] = has_upright(building, static_cast<int>(i), config);
    habitable[i] = upright[i] && (has_floor(building, static_cast<int>(i), config) ||
                                  has_door(building, static_cast<int>(i), config));
  }
  if (std::none_of(habitable.begin(), habitable.end(), [](bool b) { return b; })) habitable = upright;
  const auto lowest = std::find(habitable.begin(), habitable.end(), true);
  if (lowest == habitable.end()) {
    building.warnings.push_back({"", "storey_kinds", "nothing stands on any storey; all are taken as habitable"});
    return;
  }
  const auto first = static_cast<std::size_t>(lowest - habitable.begin());
  for (std::size_t i = 0; i < n; ++i) {
    const StoreyKind other = i < first ? StoreyKind::foundation : StoreyKind::roof;
    building.storeys[i].kind = habitable[i] ? StoreyKind::habitable : other;
  }
}

}  // namespace plumbline::bim
