// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/formats/ifc/read/interpret.h"
#include "bim/formats/ifc/read/material_names.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/body_section.h"

namespace plumbline::bim {
namespace {

/// The largest piece of an outline; of equal ones the first in canonical order.
const PolygonWithHoles2& largest(const std::vector<PolygonWithHoles2>& pieces) {
  return *std::max_element(pieces.begin(), pieces.end(), [](const PolygonWithHoles2& a, const PolygonWithHoles2& b) {
    return signed_area(a.outer) < signed_area(b.outer);
  });
}

double shared_area(const Room& a, const Room& b) {
  if (a.holes.empty() && b.holes.empty()) return intersection_area(a.polygon, b.polygon);
  return area(intersect({a.outline()}, {b.outline()}));
}

/// A space that holds all others of its storey, which fill most of it: an area of the storey and no room.
bool covers_the_others(const Room& room, const std::vector<Room>& rooms) {
  constexpr double least_share = 0.95, least_filled = 0.5;
  const double own = room.area_m2();
  double filled = 0.0;
  int others = 0;
  for (const Room& other : rooms) {
    if (&other == &room || other.storey != room.storey) continue;
    const double area = other.area_m2();
    if (area >= own || shared_area(room, other) < least_share * area) return false;
    filled += area;
    ++others;
  }
  return others >= 2 && filled >= least_filled * own;
}

/// Whether two spaces are one place that the file holds twice: they stand on one floor and share most of the larger.
/// Real rooms share no more than the walls between them, and one within a hall is much smaller than that; an outline to
/// the axes of the walls around even a closet is less than twice as large as the closet.
bool same_place(const Room& a, const Region2& outline_a, const Room& b, const Region2& outline_b) {
  constexpr double least_share = 0.5, same_floor_m = 0.5;
  if (a.storey != b.storey || std::abs(a.z0_m - b.z0_m) > same_floor_m || a.z0_m >= b.z1_m || b.z0_m >= a.z1_m)
    return false;
  const double larger = std::max(area(outline_a), area(outline_b));
  Eigen::AlignedBox2d box_a, box_b;
  for (const Eigen::Vector2d& p : a.polygon) box_a.extend(p);
  for (const Eigen::Vector2d& p : b.polygon) box_b.extend(p);
  if (!box_a.intersects(box_b) || box_a.intersection(box_b).volume() < least_share * larger) return false;
  return area(intersect(outline_a, outline_b)) >= least_share * larger;
}

/// Area of an outline that lies in walls, m^2.
double area_in_walls(const Room& room, const Region2& outline, const std::vector<Wall>& walls) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  double sum = 0.0;
  for (const Wall& wall : walls) {
    Eigen::AlignedBox2d on_plan;
    for (const Eigen::Vector3d& p : wall.body->vertices) on_plan.extend(Eigen::Vector2d(p.head<2>()));
    const double low = std::max(room.z0_m, wall.z0_m), high = std::min(room.z1_m, wall.z1_m);
    if (low >= high || !box.intersects(on_plan)) continue;
    sum += area(intersect(outline, wall_section(wall, 0.5 * (low + high))));
  }
  return sum;
}

/// Whether the second of two spaces in one place is the better room. It is the larger one, unless most of what that has
/// more lies in walls, as where it goes on to their axes; of equal ones the lowest number.
bool second_is_the_room(const Room& a, const Region2& outline_a, const Room& b, const Region2& outline_b,
                        const std::vector<Wall>& walls) {
  constexpr double same_m2 = 0.01, most_share = 0.5;
  const double more = area(outline_b) - area(outline_a);
  if (std::abs(more) < same_m2) return b.step_id < a.step_id;
  const double in_walls = area_in_walls(b, outline_b, walls) - area_in_walls(a, outline_a, walls);
  const bool larger_is_net = in_walls / more < most_share;
  return (more > 0.0) == larger_is_net;
}

/// Leaves out those that cover the others, and adds their names to a list.
void leave_out_covering_rooms(std::vector<Room>& rooms, std::vector<std::string>& left_out) {
  std::vector<bool> whole;
  for (const Room& room : rooms) whole.push_back(covers_the_others(room, rooms));
  for (std::size_t i = rooms.size(); i-- > 0;) {
    if (!whole[i]) continue;
    left_out.push_back(rooms[i].name + " (covers the others)");
    rooms.erase(rooms.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Leaves one room a place.
void leave_out_double_rooms(Building& building) {
  std::vector<Room>& rooms = building.rooms;
  std::vector<Region2> outlines;
  for (const Room& room : rooms) outlines.push_back({room.outline()});
  std::vector<bool> left_out(rooms.size(), false);
  const auto named = [](const Room& room) { return "'" + room.name + "' (" + room.id + ")"; };
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    for (std::size_t k = 0; k < i && !left_out[i]; ++k) {
      if (left_out[k] || !same_place(rooms[k], outlines[k], rooms[i], outlines[i])) continue;
      const bool second = second_is_the_room(rooms[k], outlines[k], rooms[i], outlines[i], building.walls);
      const std::size_t room = second ? i : k, other = second ? k : i;
      left_out[other] = true;
      building.warnings.push_back({rooms[other].id, "double_space",
                                   "space " + named(rooms[other]) + " lies where " + named(rooms[room]) +
                                       " does, which is the room, and is left out"});
    }
  }
  std::size_t at = 0;
  std::erase_if(rooms, [&](const Room&) { return left_out[at++]; });
}

template <class Element>
Element element_of(const StepProduct& product) {
  Element element;
  element.id = product.id;
  element.step_id = product.step_id;
  return element;
}

}  // namespace

/// Nullopt, with a warning, where its body has no area on the plan or cannot be read.
std::optional<Room> Interpreter::room_of(const StepProduct& space) {
  const Solid body = body_of(space);
  if (body.triangles.empty()) return std::nullopt;
  const std::vector<PolygonWithHoles2> outline = footprint(body);
  if (outline.empty()) {
    warn(space, "no_body", "has no area on the plan, and is left out");
    return std::nullopt;
  }
  if (outline.size() > 1) warn(space, "room_pieces", "its outline has several pieces; the largest is the room");
  const PolygonWithHoles2& piece = largest(outline);
  Room room = element_of<Room>(space);
  room.name = space.name;
  room.polygon = piece.outer;
  room.holes = piece.holes;
  const Extent box = extent(body);
  room.z0_m = snapped(box.low.z());
  room.z1_m = snapped(box.high.z());
  room.storey = storey_index(space, room.z0_m);
  return room;
}

void Interpreter::add_rooms() {
  std::vector<std::string> left_out;
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::space) continue;
    if (product.space_use != SpaceUse::room) {
      left_out.push_back(product.name + (product.space_use == SpaceUse::gross ? " (gross area)" : " (outside)"));
      continue;
    }
    if (product.body.empty() && !product.outline.empty()) continue;  // comes when all rooms with a body are known
    if (std::optional<Room> room = room_of(product)) building_.rooms.push_back(std::move(*room));
  }
  leave_out_covering_rooms(building_.rooms, left_out);
  leave_out_double_rooms(building_);
  std::string list;
  for (const std::string& name : left_out) list += (list.empty() ? "" : ", ") + name;
  if (!list.empty()) building_.warnings.push_back({"", "not_a_room", "spaces that are no rooms are left out: " + list});
}

void Interpreter::add_slabs() {
  for (const StepProduct& product : model_.products) {
    const bool roof = product.kind == StepClass::roof;
    if ((product.kind != StepClass::slab && !roof) || within(product, StepClass::stair)) continue;
    if (roof && !product.has_body && parts_.contains(product.step_id)) continue;  // its slabs stand for themselves
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    const std::vector<PolygonWithHoles2> outline = footprint(body);
    const Extent box = extent(body);
    if (outline.empty()) {
      warn(product, "no_area", "has no area on the plan; kept as an obstacle");
      add_obstacle(product, "slab", product.material, std::move(body));
      continue;
    }
    Slab slab = element_of<Slab>(product);
    slab.material = product.material;
    if (outline.size() > 1) warn(product, "slab_pieces", "has several pieces; the robot walks on the largest only");
    slab.polygon = largest(outline);
    slab.z0_m = snapped(box.low.z());
    slab.z1_m = snapped(box.high.z());
    slab.storey = storey_index(product, slab.z0_m);
    slab.body = std::move(body);
    building_.slabs.push_back(std::move(slab));
  }
  if (!building_.slabs.empty()) return;
  for (const StepProduct& product : model_.products)
    if (is_nameless(product)) take_as_slab(product);
}

bool Interpreter::is_nameless(const StepProduct& product) const {
  const StepProduct* whole = find(product.whole);
  const bool part = product.kind == StepClass::part &&
                    (whole == nullptr || whole->kind == StepClass::obstacle || whole->kind == StepClass::storey);
  if ((product.kind != StepClass::obstacle && !part) || taken_.contains(product.step_id) || product.body.empty() ||
      within(product, StepClass::curtain_wall))
    return false;
  const std::string kind = obstacle_kind(product.type);
  return part || kind == "proxy" || kind == "plate" || kind == "covering" || kind == "footing";
}

bool Interpreter::is_of_layers(const StepProduct& product) const {
  const auto parts = parts_.find(product.step_id);
  return product.kind == StepClass::obstacle && !product.has_body && parts != parts_.end() &&
         !within(product, StepClass::curtain_wall) &&
         std::all_of(parts->second.begin(), parts->second.end(),
                     [](const StepProduct* part) { return part->kind == StepClass::part && part->has_body; });
}

/// A flat element that is level on top.
void Interpreter::take_as_slab(const StepProduct& product) {
  const LookalikeConfig config;
  if (product.ceiling) return;
  Solid body = joined(uncut_solids(product));
  if (body.triangles.empty()) return;
  const Extent box = extent(body);
  if (box.high.z() - box.low.z() > config.most_thickness_m) return;
  const std::vector<PolygonWithHoles2> outline = footprint(body);
  if (outline.empty() || area(outline) < config.least_floor_m2) return;
  Slab slab = element_of<Slab>(product);
  slab.material = product.material;
  slab.polygon = largest(outline);
  slab.z0_m = snapped(box.low.z());
  slab.z1_m = snapped(box.high.z());
  Solid top{body.vertices, {}};
  for (const Eigen::Vector3i& t : body.triangles)
    if (std::all_of(t.begin(), t.end(), [&](int i) {
          return body.vertices[static_cast<std::size_t>(i)].z() > box.high.z() - config_.layer_match_m;
        }))
      top.triangles.push_back(t);
  if (area(footprint(top)) < config.level_share * area(outline)) return;
  slab.storey = storey_index(product, slab.z0_m);
  // A covering over one's head is a ceiling, whatever the file calls it.
  const double elevation_m = building_.storeys[static_cast<std::size_t>(slab.storey)].elevation_m;
  if (obstacle_kind(product.type) == "covering" && slab.z0_m > elevation_m + config.least_height_m) return;
  slab.body = std::move(body);
  taken_.insert(product.step_id);
  warn(product, "taken_as_slab", "the file has no IfcSlab; this lies like a floor");
  building_.slabs.push_back(std::move(slab));
}

void Interpreter::add_columns() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::column) continue;
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    const std::vector<PolygonWithHoles2> outline = footprint(body);
    if (outline.empty()) {
      warn(product, "no_area", "has no area on the plan; kept as an obstacle");
      add_obstacle(product, "column", product.material, std::move(body));
      continue;
    }
    Column column = element_of<Column>(product);
    column.material = product.material;
    column.footprint = largest(outline).outer;
    const Extent box = extent(body);
    column.z0_m = snapped(box.low.z());
    column.z1_m = snapped(box.high.z());
    column.storey = storey_index(product, column.z0_m);
    column.body = std::move(body);
    building_.columns.push_back(std::move(column));
  }
}

void Interpreter::add_obstacle(const StepProduct& product, const std::string& kind, const std::string& material,
                               Solid body) {
  Obstacle obstacle = element_of<Obstacle>(product);
  obstacle.kind = kind;
  obstacle.material = material;
  obstacle.storey = storey_index(product, extent(body).low.z());
  obstacle.body = std::move(body);
  building_.obstacles.push_back(std::move(obstacle));
}

void Interpreter::add_obstacles() {
  for (const StepProduct& product : model_.products) {
    if (product.kind == StepClass::hidden) {
      if (product.has_body) warn(product, "left_out", "lies within other elements or around the building");
      continue;
    }
    const bool obstacle = product.kind == StepClass::obstacle || product.kind == StepClass::part ||
                          product.kind == StepClass::curtain_wall;
    if (!obstacle || taken_.contains(product.step_id)) continue;
    const bool in_curtain = within(product, StepClass::curtain_wall);
    const bool group = !product.has_body && (parts_.contains(product.step_id) || in_curtain);
    if (group) continue;  // its parts stand for themselves
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    std::string kind = obstacle_kind(product.type);
    if (kind == "covering") body = opened_at_doors(product, std::move(body));
    if (in_curtain) kind = kind == "plate" ? "curtain_panel" : kind == "member" ? "mullion" : kind;
    const bool pane = kind == "curtain_panel" && (says_glass(product.material) || says_glass(product.name));
    add_obstacle(product, kind, pane ? "glass" : product.material, std::move(body));
  }
}

}  // namespace plumbline::bim
