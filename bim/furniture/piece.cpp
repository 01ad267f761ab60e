// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/piece.h"

#include <numbers>

namespace plumbline::bim {

namespace {

double radians(double deg) { return deg * std::numbers::pi / 180.0; }

}  // namespace

Footprint footprint_of(const FurniturePiece& piece) {
  return footprint_of(turned_rectangle(piece.at, piece.size, radians(piece.yaw_deg)));
}

Obstacle obstacle_of(const FurniturePiece& piece) {
  Obstacle obstacle;
  obstacle.id = piece.id;
  obstacle.kind = "furniture";
  obstacle.storey = piece.storey;
  obstacle.body = furniture_solid(piece.shape, {piece.size.x(), piece.size.y(), piece.height_m}, piece.at,
                                  radians(piece.yaw_deg), piece.floor_z_m);
  return obstacle;
}

void FurnitureIds::take(const Building& building) {
  const auto take_all = [&](const auto& elements) {
    for (const auto& element : elements)
      if (element.id.starts_with("furniture_")) taken_.insert(element.id);
  };
  take_all(building.storeys);
  take_all(building.walls);
  take_all(building.openings);
  take_all(building.rooms);
  take_all(building.slabs);
  take_all(building.columns);
  take_all(building.stairs);
  take_all(building.obstacles);
}

std::string FurnitureIds::next() {
  for (;;) {
    std::string id = "furniture_" + std::to_string(++number_);
    if (!taken_.contains(id)) return id;
  }
}

}  // namespace plumbline::bim
