// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/as_built_rooms.h"

#include <algorithm>
#include <cmath>

#include "bim/formats/plan_yaml/unused_id.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/rooms.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

std::vector<Wall> walls_on(const Building& building, int storey) {
  std::vector<Wall> walls;
  for (const Wall& wall : building.walls)
    if (wall.storey == storey) walls.push_back(wall);
  return walls;
}

/// What walls enclose, openings aside, counter-clockwise, in canonical order.
std::vector<Polygon2> enclosed_cells(const std::vector<Wall>& walls) {
  std::vector<Polygon2> footprints, cells;
  for (const Wall& wall : walls) footprints.push_back(footprint(wall));
  for (const PolygonWithHoles2& piece : unite(footprints))
    for (const Polygon2& hole : piece.holes) cells.emplace_back(hole.rbegin(), hole.rend());
  return cells;
}

double area_of(const Polygon2& polygon) { return std::abs(signed_area(polygon)); }

double difference(const Polygon2& a, const Polygon2& b) {
  return area_of(a) + area_of(b) - 2.0 * intersection_area(a, b);
}

/// Rooms of one storey as they are built.
class StoreyRooms {
 public:
  StoreyRooms(const Building& as_planned, const Building& as_built, int storey, const AsBuiltRoomConfig& config)
      : config_(config),
        storey_(storey),
        walls_(walls_on(as_built, storey)),
        cells_(enclosed_cells(walls_)),
        members_(cells_.size()) {
    const std::vector<Polygon2> planned = enclosed_cells(walls_on(as_planned, storey));
    for (const Room& room : as_built.rooms) {
      const double allowed = config.same_share * area_of(room.polygon);
      const bool closed = room.storey == storey &&
                          std::any_of(planned.begin(), planned.end(),
                                      [&](const Polygon2& cell) { return difference(cell, room.polygon) < allowed; });
      closed_.push_back(closed);
      if (closed) assign(room.polygon, static_cast<int>(closed_.size()) - 1);
    }
  }

  /// New outlines of the building's rooms, empty where there is no such room any more; then the rooms cut off.
  void rebuild(Building& as_built, std::vector<Change>& changes) const {
    std::vector<Polygon2> outlines(as_built.rooms.size());
    for (std::size_t i = 0; i < outlines.size(); ++i)
      if (as_built.rooms[i].storey != storey_)
        outlines[i] = as_built.rooms[i].polygon;
      else if (!closed_[i])
        outlines[i] = open_plan_outline(as_built.rooms[i].polygon);
    std::vector<Room> cut_off;
    for (std::size_t c = 0; c < cells_.size(); ++c) settle_cell(c, as_built, outlines, cut_off);
    for (std::size_t i = 0; i < outlines.size(); ++i) reshape(as_built.rooms[i], outlines[i], changes);
    for (Room& room : cut_off) {
      changes.push_back({"add_room", room.id});
      as_built.rooms.push_back(std::move(room));
    }
  }

 private:
  /// Joins a room to the cell that holds most of it; of nested ones the smallest.
  void assign(const Polygon2& polygon, int room) {
    int best = -1;
    double best_area = config_.remnant_m2;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const double shared = intersection_area(cells_[c], polygon);
      const bool nested = best >= 0 && std::abs(shared - best_area) < config_.same_m2;
      if (nested ? area_of(cells_[c]) >= area_of(cells_[static_cast<std::size_t>(best)]) : shared <= best_area)
        continue;
      best = static_cast<int>(c);
      best_area = shared;
    }
    if (best >= 0) members_[static_cast<std::size_t>(best)].push_back({room, best_area});
  }

  [[nodiscard]] Polygon2 open_plan_outline(const Polygon2& polygon) const {
    const std::vector<Polygon2> pieces = clear_outlines(polygon, walls_);
    if (pieces.empty() || area_of(pieces.front()) < config_.remnant_m2) return {};
    return pieces.front();
  }

  [[nodiscard]] bool holds_open_plan(const Polygon2& cell, const Building& as_built) const {
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      const Room& room = as_built.rooms[i];
      if (room.storey == storey_ && !closed_[i] && intersection_area(cell, room.polygon) > config_.open_plan_m2)
        return true;
    }
    return false;
  }

  /// Gives the cell to the member with the largest part of it (ties: the first room), or to a new room.
  void settle_cell(std::size_t c, const Building& as_built, std::vector<Polygon2>& outlines,
                   std::vector<Room>& cut_off) const {
    if (holds_open_plan(cells_[c], as_built)) return;
    const auto& members = members_[c];
    if (!members.empty()) {
      const auto largest = std::max_element(members.begin(), members.end(),
                                            [](const Member& a, const Member& b) { return a.shared < b.shared; });
      outlines[static_cast<std::size_t>(largest->room)] = cells_[c];
      return;
    }
    for (std::size_t i = 0; i < closed_.size(); ++i) {
      const Room& source = as_built.rooms[i];
      const double shared = closed_[i] ? intersection_area(cells_[c], source.polygon) : 0.0;
      if (shared < config_.remnant_m2 || shared < 0.5 * area_of(cells_[c])) continue;
      Room room = source;
      room.id = unused_id(source.id, as_built.rooms, cut_off);
      room.name = room.id;
      room.polygon = cells_[c];
      room.walls.clear();
      room.virtual_edges.clear();
      cut_off.push_back(std::move(room));
      return;
    }
  }

  void reshape(Room& room, const Polygon2& outline, std::vector<Change>& changes) const {
    if (!outline.empty() && difference(room.polygon, outline) < config_.same_m2) return;
    changes.push_back({outline.empty() ? "drop_room" : "reshape_room", room.id});
    room.polygon = outline;
    room.walls.clear();
  }

  struct Member {
    int room = -1;
    double shared = 0.0;
  };
  const AsBuiltRoomConfig& config_;
  int storey_;
  std::vector<Wall> walls_;
  std::vector<Polygon2> cells_;
  std::vector<std::vector<Member>> members_;  ///< rooms of each cell
  std::vector<bool> closed_;                  ///< rooms that walls enclosed as planned
};

/// Removes the rooms without an outline; indices of rooms in other elements follow.
void erase_dropped(Building& building) {
  std::vector<int> renumbered;
  int next = 0;
  for (const Room& room : building.rooms) renumbered.push_back(room.polygon.empty() ? -1 : next++);
  const auto follow = [&](int& room) {
    if (room >= 0) room = renumbered[static_cast<std::size_t>(room)];
  };
  for (Opening& opening : building.openings)
    for (int& room : opening.rooms) follow(room);
  for (Stair& stair : building.stairs)
    for (int& room : stair.rooms) follow(room);
  for (Room& room : building.rooms)
    for (VirtualEdge& edge : room.virtual_edges) follow(edge.room);
  std::erase_if(building.rooms, [](const Room& room) { return room.polygon.empty(); });
}

}  // namespace

void rebuild_rooms(const Building& as_planned, const std::set<int>& storeys, Building& as_built,
                   std::vector<Change>& changes, const AsBuiltRoomConfig& config) {
  for (const int storey : storeys) {
    StoreyRooms(as_planned, as_built, storey, config).rebuild(as_built, changes);
    erase_dropped(as_built);
  }
  find_room_walls(as_built);
  find_opening_rooms(as_built);
}

}  // namespace plumbline::bim
