// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/room_places.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace plumbline::scenarios {

namespace {

constexpr double coordinate_steps = 1e4;

std::vector<int> storeys_upwards(const bim::Building& building) {
  std::vector<int> order;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return building.storeys[static_cast<std::size_t>(a)].elevation_m <
           building.storeys[static_cast<std::size_t>(b)].elevation_m;
  });
  return order;
}

}  // namespace

Eigen::Vector2d rounded(const Eigen::Vector2d& p) {
  return ((p * coordinate_steps).array().round() / coordinate_steps).matrix();
}

RoomPlaces::RoomPlaces(const bim::Building& as_built, const sim::MultiStoreyPlanner& space)
    : building_(as_built), space_(space), places_(as_built.rooms.size()) {}

const std::optional<sim::FloorPoint>& RoomPlaces::of(int room) const {
  std::optional<std::optional<sim::FloorPoint>>& place = places_.at(static_cast<std::size_t>(room));
  if (place) return *place;
  const bim::Room& of = building_.rooms[static_cast<std::size_t>(room)];
  const std::vector<Eigen::Vector2d> found = space_.storey(of.storey).room_target(of.polygon);
  place.emplace();
  if (!found.empty()) *place = sim::FloorPoint{of.storey, rounded(found.front())};
  return *place;
}

RoomPlaces::Start RoomPlaces::start_on(int storey) const {
  struct Piece {
    double area_m2 = 0.0, largest_m2 = 0.0;
    Start start;
  };
  std::map<int, Piece> pieces;
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    if (building_.rooms[i].storey != storey || !of(static_cast<int>(i))) continue;
    const double area = std::abs(signed_area(building_.rooms[i].polygon));
    Piece& piece = pieces[space_.storey(storey).region(of(static_cast<int>(i))->p_W)];
    ++piece.start.rooms;
    piece.area_m2 += area;
    if (area <= piece.largest_m2) continue;
    piece.largest_m2 = area;
    piece.start.room = static_cast<int>(i);
  }
  Piece best;
  for (const auto& [region, piece] : pieces)
    if (piece.area_m2 > best.area_m2) best = piece;
  return best.start;
}

int RoomPlaces::start_storey() const {
  int fallback = -1;
  for (const int storey : storeys_upwards(building_)) {
    const Start start = start_on(storey);
    if (start.rooms > 1) return storey;
    if (start.room >= 0 && fallback < 0) fallback = storey;
  }
  return fallback;
}

}  // namespace plumbline::scenarios
