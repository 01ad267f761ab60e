// SPDX-License-Identifier: Apache-2.0
// Spaces that have no body but an outline on the plan.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/boxes.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {
namespace {

constexpr double same_floor_m = 1.0;  // up or down: half a storey and less

/// Whether a slab lies under a place, or the file has none.
bool lies_on_slab(const std::vector<Slab>& slabs, const Eigen::Vector2d& p, double z_m) {
  constexpr double near_m = 0.6;
  return slabs.empty() || std::any_of(slabs.begin(), slabs.end(), [&](const Slab& slab) {
           return std::abs(slab.z1_m - z_m) < near_m && contains(slab.polygon, p);
         });
}

/// What rooms leave of a region. What they go round is not theirs.
Region2 without_rooms(const Region2& region, const std::vector<const Room*>& rooms) {
  std::vector<Polygon2> outlines;
  for (const Room* room : rooms)
    if (room->holes.empty()) outlines.push_back(room->polygon);
  Region2 free = subtract(region, outlines);
  for (const Room* room : rooms) {
    if (room->holes.empty()) continue;
    Region2 rest = subtract(free, std::vector<Polygon2>{room->polygon});
    for (PolygonWithHoles2& piece : intersect(free, unite(room->holes))) rest.push_back(std::move(piece));
    free = std::move(rest);
  }
  return free;
}

/// Whether an outline holds several rooms that fill most of it: that of a flat or a storey, and no room.
bool covers_rooms(const Region2& outline, const std::vector<const Room*>& rooms) {
  constexpr double least_share = 0.95, least_filled = 0.5;
  double filled_m2 = 0.0;
  int held = 0;
  const Eigen::AlignedBox2d box = outline.empty() ? Eigen::AlignedBox2d() : box_of(outline.front().outer);
  for (const Room* room : rooms) {
    const double own_m2 = room->area_m2();
    // Exact booleans of all neighbours would take long.
    const Eigen::AlignedBox2d own_box = box_of(room->polygon);
    if (!own_box.intersects(box) || own_box.intersection(box).volume() < least_share * own_m2) continue;
    if (area(intersect(outline, {room->outline()})) < least_share * own_m2) continue;
    filled_m2 += own_m2;
    ++held;
  }
  return held >= 2 && filled_m2 >= least_filled * area(outline);
}

}  // namespace

/// Where the spaces without a body lie, of those that have an outline. Of one place the first by id.
std::vector<Interpreter::NamedPlace> Interpreter::places_of_outlines() const {
  constexpr std::size_t most_corners = 1000;  // of a room; bounds the time
  std::vector<NamedPlace> places;
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::space || product.space_use != SpaceUse::room) continue;
    if (product.outline.size() < 3 || product.outline.size() > most_corners) continue;
    Polygon2 outline;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : product.outline) {
      sum += product.X_WP * p;
      outline.emplace_back((product.X_WP * p).head<2>());
    }
    if (!sum.allFinite() || !is_simple(outline)) continue;
    if (signed_area(outline) < 0.0) std::reverse(outline.begin(), outline.end());
    const Eigen::Vector2d inner = interior_point(outline);
    places.push_back({inner, (product.X_WP * product.outline.front()).z(), product.name, std::move(outline), &product});
  }
  return places;
}

/// The largest piece of a place that is free of rooms and walls. Nullopt where there is none, where a room at least
/// half as large as the outline holds its inner point, and where the outline holds several rooms.
std::optional<PolygonWithHoles2> Interpreter::free_piece(const NamedPlace& place, const BoxIndex& room_boxes,
                                                         const BoxIndex& wall_boxes) const {
  constexpr double least_m2 = 0.5, least_share = 0.5;
  std::vector<const Room*> rooms;
  for (const int i : room_boxes.near(place.outline, 0.0)) {
    const Room& room = building_.rooms[static_cast<std::size_t>(i)];
    if (std::abs(room.z0_m - place.z_m) >= same_floor_m) continue;
    if (room.contains(place.inner) && room.area_m2() >= least_share * signed_area(place.outline)) return std::nullopt;
    rooms.push_back(&room);
  }
  const Region2 outline = unite(std::vector<Polygon2>{place.outline});
  if (covers_rooms(outline, rooms)) return std::nullopt;
  std::vector<Polygon2> walls;
  for (const int i : wall_boxes.near(place.outline, 0.0)) {
    const Wall& wall = building_.walls[static_cast<std::size_t>(i)];
    if (wall.z0_m < place.z_m + same_floor_m && wall.z1_m > place.z_m + same_floor_m) walls.push_back(footprint(wall));
  }
  std::optional<PolygonWithHoles2> best;
  double best_m2 = least_m2;
  for (PolygonWithHoles2& piece : subtract(without_rooms(outline, rooms), walls)) {
    const double piece_m2 = area(Region2{piece});
    if (piece_m2 < best_m2 || (best && piece_m2 == best_m2)) continue;
    best_m2 = piece_m2;
    best = std::move(piece);
  }
  return best;
}

/// A space without a body is the room of its outline where no other room is; of two that overlap the smaller first.
void Interpreter::add_rooms_of_outlines(std::vector<NamedPlace> places) {
  constexpr double least_height_m = 1.8;
  std::stable_sort(places.begin(), places.end(), [](const NamedPlace& a, const NamedPlace& b) {
    return signed_area(a.outline) < signed_area(b.outline);
  });
  const BoxIndex wall_boxes = boxes_of(building_.walls);
  BoxIndex room_boxes = boxes_of(building_.rooms);
  for (const NamedPlace& place : places) {
    if (placed_.contains(place.space->step_id) || building_.storeys.empty()) continue;
    if (!lies_on_slab(building_.slabs, place.inner, place.z_m)) continue;
    std::optional<PolygonWithHoles2> piece = free_piece(place, room_boxes, wall_boxes);
    if (!piece) continue;
    Room room;
    room.id = place.space->id;
    room.step_id = place.space->step_id;
    room.name = place.name;
    room.storey = storey_index(*place.space, place.z_m);
    room.polygon = std::move(piece->outer);
    room.holes = std::move(piece->holes);
    const Storey& on = building_.storeys[static_cast<std::size_t>(room.storey)];
    room.z0_m = snapped(place.z_m);
    room.z1_m = snapped(std::max(on.elevation_m + on.height_m, room.z0_m + least_height_m));
    warn(*place.space, "inferred_room", "its outline on the plan is the room, as high as its storey");
    placed_.insert(room.step_id);
    room_boxes.add(room.polygon);
    building_.rooms.push_back(std::move(room));
  }
}

/// Says of every space without a body but with an outline what that was good for.
void Interpreter::warn_of_outlines() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::space || product.space_use != SpaceUse::room) continue;
    if (!product.body.empty() || product.outline.empty()) continue;
    warn(product, "no_body",
         placed_.contains(product.step_id)
             ? "has no body that can be read; its outline on the plan says where it is"
             : "has no body that can be read, nor an outline where a room is missing, and is left out");
  }
}

}  // namespace plumbline::bim
