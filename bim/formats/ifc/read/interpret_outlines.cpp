// SPDX-License-Identifier: Apache-2.0
// Spaces that have no body but an outline on the plan.
#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/rooms.h"

namespace plumbline::bim {
namespace {

/// Whether a slab lies under a place, or the file has none.
bool lies_on_slab(const std::vector<Slab>& slabs, const Eigen::Vector2d& p, double z_m) {
  constexpr double near_m = 0.6;
  return slabs.empty() || std::any_of(slabs.begin(), slabs.end(), [&](const Slab& slab) {
           return std::abs(slab.z1_m - z_m) < near_m && contains(slab.polygon, p);
         });
}

}  // namespace

/// Where the spaces without a body lie, of those that have a name and an outline. Of one place the first by id.
std::vector<Interpreter::NamedPlace> Interpreter::places_of_outlines() const {
  constexpr std::size_t most_corners = 1000;  // of a room; bounds the time
  std::vector<NamedPlace> places;
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::space || product.space_use != SpaceUse::room || product.name.empty()) continue;
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

/// A space without a body is the room of its outline where no other room is.
void Interpreter::add_rooms_of_outlines() {
  constexpr double least_m2 = 0.5, same_floor_m = 1.0, least_height_m = 1.8;
  for (const NamedPlace& place : places_of_outlines()) {
    const int storey = storey_index(*place.space, place.z_m);
    std::vector<Polygon2> taken;
    bool found = false;
    for (const Room& room : building_.rooms) {
      if (std::abs(room.z0_m - place.z_m) >= same_floor_m) continue;
      found = found || room.contains(place.inner);
      taken.push_back(room.polygon);
    }
    if (found || building_.storeys.empty() || !lies_on_slab(building_.slabs, place.inner, place.z_m)) continue;
    std::vector<Wall> walls;
    for (const Wall& wall : building_.walls)
      if (wall.z0_m < place.z_m + same_floor_m && wall.z1_m > place.z_m + same_floor_m) walls.push_back(wall);
    Polygon2 best;
    for (const PolygonWithHoles2& free : subtract(unite(std::vector<Polygon2>{place.outline}), taken))
      for (Polygon2& piece : clear_outlines(free.outer, walls))
        if (best.empty() || signed_area(piece) > signed_area(best)) best = std::move(piece);
    if (best.empty() || signed_area(best) < least_m2) continue;
    const Storey& on = building_.storeys[static_cast<std::size_t>(storey)];
    Room room;
    room.id = place.space->id;
    room.step_id = place.space->step_id;
    room.name = place.name;
    room.storey = storey;
    room.polygon = std::move(best);
    room.z0_m = snapped(place.z_m);
    room.z1_m = snapped(std::max(on.elevation_m + on.height_m, room.z0_m + least_height_m));
    warn(*place.space, "inferred_room", "its outline on the plan is the room, as high as its storey");
    building_.rooms.push_back(std::move(room));
  }
}

}  // namespace plumbline::bim
