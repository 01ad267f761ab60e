// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/room_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bim/config/tree.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/steep_floors.h"
#include "sim/route/clearance_map.h"

namespace plumbline::scenarios {

namespace {

constexpr double coordinate_steps = 1e4;

}  // namespace

Eigen::Vector2d rounded(const Eigen::Vector2d& p) {
  return ((p * coordinate_steps).array().round() / coordinate_steps).matrix();
}

std::string quoted(const bim::Room& room) {
  return "'" + room.id + "'" + (room.name.empty() || room.name == room.id ? "" : " (" + room.name + ")");
}

RoomPlaces::RoomPlaces(const bim::Building& as_built, const sim::MultiStoreyPlanner& space,
                       const std::optional<sim::FloorPoint>& from, std::vector<int> inside)
    : building_(as_built), space_(space), from_(from), inside_(std::move(inside)), places_(as_built.rooms.size()) {}

const std::optional<sim::FloorPoint>& RoomPlaces::of(int room) const {
  std::optional<std::optional<sim::FloorPoint>>& place = places_.at(static_cast<std::size_t>(room));
  if (place) return *place;
  const bim::Room& of = building_.rooms[static_cast<std::size_t>(room)];
  const std::vector<Eigen::Vector2d> found = space_.storey(of.storey).room_targets(of);
  place.emplace();
  if (found.empty()) return *place;
  const auto point = [&](const Eigen::Vector2d& p) { return sim::FloorPoint{of.storey, rounded(p)}; };
  const auto reached =
      found.size() < 2 || !from_ ? found.begin() : std::find_if(found.begin(), found.end(), [&](const auto& p) {
        return !space_.path(*from_, point(p)).empty();
      });
  const Eigen::Vector2d& freest = reached == found.end() ? found.front() : *reached;
  const bool inside = std::find(inside_.begin(), inside_.end(), room) != inside_.end();
  *place = point(inside ? space_.storey(of.storey).inner_target(of, freest) : freest);
  return *place;
}

bool RoomPlaces::has_floor(int room) const {
  constexpr double least_share = 0.3;
  const bim::Room& of = building_.rooms[static_cast<std::size_t>(room)];
  const sim::ClearanceMap& floor = space_.storey(of.storey);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : of.polygon) box.extend(p);
  const double cell = floor.grid().cell;
  double cells = 0.0, with_floor = 0.0;
  for (double y = box.min().y(); y <= box.max().y(); y += cell)
    for (double x = box.min().x(); x <= box.max().x(); x += cell) {
      if (!of.contains({x, y})) continue;
      ++cells;
      if (const auto at = floor.grid().find({x, y}); at && floor.has_floor(*at)) ++with_floor;
    }
  return with_floor >= least_share * cells;
}

std::string RoomPlaces::why_none(int room) const {
  const bim::Room& of = building_.rooms[static_cast<std::size_t>(room)];
  const sim::ClearanceMap& floor = space_.storey(of.storey);
  const std::optional<std::size_t> freest = floor.freest_cell(of);
  if (!freest) return "it is smaller than the robot";
  if (!has_floor(room)) {
    const Eigen::Vector2d p = interior_point(of.polygon);
    for (const bim::SteepFloor& floor : bim::steep_floors(building_, of.storey, of.z0_m))
      if (contains(floor.polygon, p)) return bim::too_steep_text(floor);
    return "there is no floor in it near the level of its storey";
  }
  const auto metres = [](double x) { return format_number(std::round(x * 1e2) / 1e2) + " m"; };
  return "it has no place where the robot can turn round: " + metres(2.0 * floor.cell_clearance(*freest)) +
         " are free, and it needs " + metres(2.0 * floor.config().turn_m);
}

std::string RoomPlaces::why_nowhere() const {
  if (building_.rooms.empty()) return "it has no rooms";
  const auto largest =
      std::max_element(building_.rooms.begin(), building_.rooms.end(),
                       [](const bim::Room& a, const bim::Room& b) { return a.area_m2() < b.area_m2(); });
  return "room " + quoted(*largest) + ": " + why_none(static_cast<int>(largest - building_.rooms.begin())) +
         (building_.rooms.size() > 1 ? "; it is the largest of " + std::to_string(building_.rooms.size()) + " rooms"
                                     : "");
}

RoomPlaces::Start RoomPlaces::start_on(int storey) const {
  struct Piece {
    double area_m2 = 0.0, largest_m2 = 0.0;
    Start start;
  };
  std::map<int, Piece> pieces;
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    if (building_.rooms[i].storey != storey || !of(static_cast<int>(i))) continue;
    const double area = building_.rooms[i].area_m2();
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
  for (const int storey : bim::storeys_upwards(building_)) {
    const Start start = start_on(storey);
    if (start.rooms > 1) return storey;
    if (start.room >= 0 && fallback < 0) fallback = storey;
  }
  return fallback;
}

}  // namespace plumbline::scenarios
