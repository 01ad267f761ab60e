// SPDX-License-Identifier: Apache-2.0
#include "bim/model/adjacency.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bim/model/boxes.h"

namespace plumbline::bim {
namespace {

Passage passage_of(OpeningKind kind) {
  switch (kind) {
    case OpeningKind::door:
      return Passage::door;
    case OpeningKind::window:
      return Passage::window;
    case OpeningKind::opening_void:
      return Passage::opening_void;
  }
  return Passage::opening_void;
}

/// The room before the outside, of two rooms the one with the lower index.
void add(std::vector<Adjacent>& list, int a, int b, Passage by, const std::string& element, double width_m) {
  if (a == b) return;
  if (a < 0 || (b >= 0 && b < a)) std::swap(a, b);
  list.push_back({a, b, by, element, width_m});
}

constexpr double hole_m = 0.5;  // between the middles of one hole's openings, across their walls

/// On the plan, in the middle of its wall.
Eigen::Vector2d middle(const Building& building, const Opening& opening) {
  const Wall& wall = building.walls[static_cast<std::size_t>(opening.wall)];
  return wall.a + opening.s_m * wall.direction() + (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
}

/// Whether two openings of different walls that stand upon or before each other are one hole.
bool is_same_hole(const Building& building, const Opening& p, const Opening& q) {
  constexpr double upon_m = 0.05, parallel = 0.05;
  if (p.wall == q.wall || p.z0_m > q.z1_m + upon_m || q.z0_m > p.z1_m + upon_m) return false;
  const Wall& wall = building.walls[static_cast<std::size_t>(q.wall)];
  const Eigen::Vector2d away = middle(building, p) - middle(building, q);
  return std::abs(building.walls[static_cast<std::size_t>(p.wall)].direction().dot(wall.left())) < parallel &&
         std::abs(away.dot(wall.direction())) < 0.5 * std::max(p.width_m, q.width_m) &&
         std::abs(away.dot(wall.left())) < hole_m;
}

}  // namespace

std::vector<bool> continued_openings(const Building& building) {
  const std::vector<Opening>& openings = building.openings;
  std::vector<bool> continued(openings.size(), false);
  std::map<std::pair<int, int>, std::vector<std::size_t>> by_rooms;
  double widest_m = 0.0;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (openings[i].kind == OpeningKind::window || openings[i].wall < 0) continue;
    by_rooms[std::minmax(openings[i].rooms[0], openings[i].rooms[1])].push_back(i);
    widest_m = std::max(widest_m, openings[i].width_m);
  }
  for (const auto& same_rooms : by_rooms) {
    const std::vector<std::size_t>& group = same_rooms.second;
    BoxIndex middles;
    for (const std::size_t i : group) middles.add({middle(building, openings[i])});
    for (const std::size_t i : group) {
      if (openings[i].kind != OpeningKind::opening_void) continue;
      const std::vector<int> near = middles.near({middle(building, openings[i])}, hole_m + 0.5 * widest_m);
      continued[i] = std::any_of(near.begin(), near.end(), [&](int n) {
        const std::size_t k = group[static_cast<std::size_t>(n)];
        return (openings[k].kind == OpeningKind::door || k < i) && is_same_hole(building, openings[i], openings[k]);
      });
    }
  }
  return continued;
}

std::vector<Adjacent> adjacency(const Building& building) {
  std::vector<Adjacent> list;
  const std::vector<bool> continued = continued_openings(building);
  for (std::size_t i = 0; i < building.openings.size(); ++i) {
    const Opening& opening = building.openings[i];
    if (continued[i]) continue;
    add(list, opening.rooms[0], opening.rooms[1], passage_of(opening.kind), opening.id, opening.width_m);
  }
  // By (room, room beyond): the two may see different parts of what is open between them (a stair beside a gallery).
  std::map<std::pair<int, int>, double> seen, open_edges;
  std::map<std::string, Adjacent> doors;
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    for (const VirtualEdge& edge : building.rooms[i].virtual_edges) {
      const double width_m = (edge.b - edge.a).norm();
      if (!edge.door.empty())
        doors.try_emplace(edge.door, Adjacent{static_cast<int>(i), edge.room, Passage::door, edge.door, width_m});
      else if (edge.room >= 0)
        seen[{static_cast<int>(i), edge.room}] += width_m;
    }
  for (const auto& [id, door] : doors) add(list, door.a, door.b, door.by, id, door.width_m);
  for (const auto& [rooms, width_m] : seen) {
    double& widest = open_edges[std::minmax(rooms.first, rooms.second)];
    widest = std::max(widest, width_m);
  }
  for (const auto& [rooms, width_m] : open_edges) add(list, rooms.first, rooms.second, Passage::open_edge, "", width_m);
  for (const Stair& stair : building.stairs) {
    if (stair.to < 0 && stair.rooms[1] < 0) continue;
    const double width_m = stair.flights.empty() ? 0.0 : stair.flights.front().width_m;
    add(list, stair.rooms[0], stair.rooms[1], Passage::stair, stair.id, width_m);
  }
  std::sort(list.begin(), list.end(), [](const Adjacent& p, const Adjacent& q) {
    return std::tie(p.a, p.b, p.by, p.element) < std::tie(q.a, q.b, q.by, q.element);
  });
  return list;
}

}  // namespace plumbline::bim
