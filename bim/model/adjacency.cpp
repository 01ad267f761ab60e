// SPDX-License-Identifier: Apache-2.0
#include "bim/model/adjacency.h"

#include <algorithm>
#include <map>
#include <tuple>

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

}  // namespace

std::vector<Adjacent> adjacency(const Building& building) {
  std::vector<Adjacent> list;
  for (const Opening& opening : building.openings)
    add(list, opening.rooms[0], opening.rooms[1], passage_of(opening.kind), opening.id, opening.width_m);
  // By (room, room beyond): the two may see different parts of what is open between them (a stair beside a gallery).
  std::map<std::pair<int, int>, double> seen, open_edges;
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    for (const VirtualEdge& edge : building.rooms[i].virtual_edges)
      if (edge.room >= 0) seen[{static_cast<int>(i), edge.room}] += (edge.b - edge.a).norm();
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
