// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/interpret.h"

namespace plumbline::bim {
namespace {

constexpr double apart_m = 1.5;        ///< nobody steps from one floor to another this far above
constexpr double person_m = 1.8;       ///< a room and a wall are at least this high
constexpr double on_slab_m = 0.35;     ///< covering between a slab and the foot of a room or wall
constexpr double before_m = 0.3;       ///< one stands this far before the face of a wall
constexpr double at_storey_m = 1.0;    ///< a storey of the file this near in height has the floor already
constexpr double least_area_m2 = 4.0;  ///< of a slab that is a floor and no landing

/// A floor above that of a storey, and the rooms that say so; none: doors do.
struct UpperFloor {
  double z_m = 0.0;
  std::vector<std::string> rooms;
};

bool lies_under(const Slab& slab, const Eigen::Vector2d& p, double foot_m) {
  return std::abs(slab.z1_m - foot_m) <= on_slab_m && signed_area(slab.polygon.outer) >= least_area_m2 &&
         contains(slab.polygon.outer, p);
}

/// Floors of a storey apart from its own, the lowest first: of rooms on slabs; without any room, of walls on slabs with
/// a door in them.
std::vector<UpperFloor> upper_floors(const Building& building, int storey) {
  const double least_m = building.storeys[static_cast<std::size_t>(storey)].elevation_m + apart_m;
  const auto has_slab = [&](const Eigen::Vector2d& p, double foot_m) {
    return std::any_of(building.slabs.begin(), building.slabs.end(),
                       [&](const Slab& slab) { return slab.storey == storey && lies_under(slab, p, foot_m); });
  };
  std::vector<UpperFloor> found;
  bool has_rooms = false;
  for (const Room& room : building.rooms) {
    if (room.storey != storey) continue;
    has_rooms = true;
    if (room.z0_m >= least_m && room.z1_m - room.z0_m >= person_m && has_slab(interior_point(room.polygon), room.z0_m))
      found.push_back({room.z0_m, {room.name.empty() ? room.id : room.name}});
  }
  for (const Opening& opening : building.openings) {
    if (has_rooms || opening.kind != OpeningKind::door || opening.z0_m < least_m) continue;
    const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
    const bool stands =
        wall.storey == storey && std::abs(wall.z0_m - opening.z0_m) <= on_slab_m && wall.z1_m - wall.z0_m >= person_m;
    const Eigen::Vector2d p = wall.a + opening.s_m * wall.direction(),
                          beside = (std::abs(wall.offset_m) + wall.thickness_m + before_m) * wall.left();
    if (stands && (has_slab(p + beside, opening.z0_m) || has_slab(p - beside, opening.z0_m)))
      found.push_back({opening.z0_m, {}});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.z_m < b.z_m; });
  std::vector<UpperFloor> floors;
  for (UpperFloor& floor : found) {
    if (floors.empty() || floor.z_m >= floors.back().z_m + apart_m)
      floors.push_back(std::move(floor));
    else
      floors.back().rooms.insert(floors.back().rooms.end(), floor.rooms.begin(), floor.rooms.end());
  }
  return floors;
}

/// The first few of the names.
std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) list += (i == 0 ? "'" : ", '") + names[i] + "'";
  return names.size() > most ? list + " and " + std::to_string(names.size() - most) + " more" : list;
}

}  // namespace

/// A file may have one storey for a whole house. What stands on an upper floor is no part of the walk otherwise.
void Interpreter::split_storeys() {
  const std::size_t count = building_.storeys.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Storey storey = building_.storeys[i];
    if (storey.step_id == 0) continue;  // assumed where its walls begin
    const auto index = static_cast<int>(i);
    std::vector<UpperFloor> floors = upper_floors(building_, index);
    std::erase_if(floors, [&](const UpperFloor& floor) {
      for (std::size_t k = 0; k < count; ++k)
        if (k != i && same_building(index, static_cast<int>(k)) &&
            std::abs(building_.storeys[k].elevation_m - floor.z_m) < at_storey_m)
          return true;
      return false;
    });
    for (std::size_t k = 0; k < floors.size(); ++k) {
      const double above_m = snapped(floors[k].z_m - storey.elevation_m);
      Storey upper = storey;
      upper.id += "/" + std::to_string(k + 2);
      upper.name += " +" + format_number(std::round(above_m * 1e2) / 1e2) + " m";
      upper.elevation_m = snapped(floors[k].z_m);
      upper.step_id = 0;
      building_.warnings.push_back(
          {storey.id, "split_storey",
           (floors[k].rooms.empty() ? "a floor with walls and doors" : "the floor of " + list_of(floors[k].rooms)) +
               " lies " + format_number(above_m) + " m above that of '" + storey.name +
               "'; it is taken as a storey, '" + upper.name + "'"});
      move_up(index, upper.elevation_m);
      uppers_[storey.step_id].push_back(static_cast<int>(building_.storeys.size()));
      if (const auto of = buildings_.find(index); of != buildings_.end())
        buildings_[static_cast<int>(building_.storeys.size())] = of->second;
      building_.storeys.push_back(std::move(upper));
    }
  }
  if (building_.storeys.size() > count) sort_storeys();
}

/// What begins on or above a floor of a storey goes to the storey that is added next.
void Interpreter::move_up(int storey, double floor_m) {
  const auto next = static_cast<int>(building_.storeys.size());
  const double least_m = floor_m - config_.storey_below_m;
  const bool split = !uppers_[building_.storeys[static_cast<std::size_t>(storey)].step_id].empty();
  const int below = split ? next - 1 : storey;
  const auto move = [&](auto& element, double foot_m) {
    if ((element.storey == storey || element.storey == below) && foot_m >= least_m) element.storey = next;
  };
  for (Room& room : building_.rooms) move(room, room.z0_m);
  for (Wall& wall : building_.walls) move(wall, wall.z0_m);
  for (Slab& slab : building_.slabs) move(slab, slab.z1_m);
  for (Obstacle& obstacle : building_.obstacles) move(obstacle, extent(obstacle.body).low.z());
}

void Interpreter::sort_storeys() {
  std::vector<std::size_t> order(building_.storeys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Storey &s = building_.storeys[a], &t = building_.storeys[b];
    return std::tie(s.elevation_m, s.id) < std::tie(t.elevation_m, t.id);
  });
  std::vector<int> place(order.size());
  std::vector<Storey> sorted;
  for (const std::size_t old : order) {
    place[old] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(building_.storeys[old]));
  }
  building_.storeys = std::move(sorted);
  const auto put = [&](int& storey) {
    if (storey >= 0) storey = place[static_cast<std::size_t>(storey)];
  };
  for (Room& room : building_.rooms) put(room.storey);
  for (Wall& wall : building_.walls) put(wall.storey);
  for (Slab& slab : building_.slabs) put(slab.storey);
  for (Obstacle& obstacle : building_.obstacles) put(obstacle.storey);
  for (auto& [step_id, storey] : storeys_) put(storey);
  for (auto& [step_id, uppers] : uppers_)
    for (int& storey : uppers) put(storey);
  std::map<int, std::int64_t> buildings;
  for (const auto& [storey, step_id] : buildings_) buildings[place[static_cast<std::size_t>(storey)]] = step_id;
  buildings_ = std::move(buildings);
}

}  // namespace plumbline::bim
