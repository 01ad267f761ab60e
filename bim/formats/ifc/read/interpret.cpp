// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/interpret.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/material_names.h"
#include "bim/formats/ifc/read/storey_kinds.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "bim/model/blocked_doors.h"
#include "bim/model/body_section.h"
#include "bim/model/boxes.h"
#include "bim/model/extrude.h"
#include "bim/model/floors.h"
#include "bim/model/infer_rooms.h"

namespace plumbline::bim {
namespace {

/// Sorts by (storey, id); returns the new place of each old index.
template <class Element>
std::vector<int> sort_elements(std::vector<Element>& elements) {
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(elements[a].storey, elements[a].id) < std::tie(elements[b].storey, elements[b].id);
  });
  std::vector<int> place(elements.size());
  std::vector<Element> sorted;
  for (const std::size_t old : order) {
    place[old] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(elements[old]));
  }
  elements = std::move(sorted);
  return place;
}

/// Boxes this close to a point may hold it: outlines count as holding what is on them.
constexpr double near_m = 1e-6;

/// Which of the rooms hold smaller ones that stand free in them.
std::vector<bool> rooms_around_others(const std::vector<Room>& rooms) {
  const BoxIndex boxes = boxes_of(rooms);
  std::vector<bool> around(rooms.size(), false);
  for (const Room& room : rooms) {
    const Eigen::Vector2d inner = interior_point(room.polygon);
    for (const int i : boxes.near({inner}, near_m)) {
      const Polygon2& outline = rooms[static_cast<std::size_t>(i)].polygon;
      if (signed_area(room.polygon) < signed_area(outline) && contains(outline, inner))
        around[static_cast<std::size_t>(i)] = true;
    }
  }
  return around;
}

/// Whether the middle of a room lies in one of others that the file gives.
bool is_given(const Room& room, const std::vector<Room>& given, const BoxIndex& given_boxes) {
  const Eigen::Vector2d inner = interior_point(room.polygon);
  const std::vector<int> near = given_boxes.near({inner}, near_m);
  return std::any_of(near.begin(), near.end(), [&](int k) {
    const Room& other = given[static_cast<std::size_t>(k)];
    return other.z0_m < room.z1_m && other.z1_m > room.z0_m && other.contains(inner);
  });
}

/// Whether a storey that is no foundation or roof has slabs, and walls or panels of a curtain wall.
bool is_built(const Building& building, int storey) {
  const auto stands_here = [&](const auto& element) { return element.storey == storey; };
  const auto is_front = [&](const Obstacle& obstacle) {
    return stands_here(obstacle) && obstacle.kind == "curtain_panel";
  };
  return building.storeys[static_cast<std::size_t>(storey)].kind == StoreyKind::habitable &&
         (std::any_of(building.walls.begin(), building.walls.end(), stands_here) ||
          std::any_of(building.obstacles.begin(), building.obstacles.end(), is_front)) &&
         std::any_of(building.slabs.begin(), building.slabs.end(), stands_here);
}

void warn_of_enclosed(const std::vector<Room>& rooms, const std::string& why, Building& building) {
  const std::vector<bool> around = rooms_around_others(rooms);
  for (std::size_t k = 0; k < rooms.size(); ++k) {
    building.warnings.push_back({rooms[k].id, "inferred_room", why + "; walls enclose this"});
    if (around[k])
      building.warnings.push_back(
          {rooms[k].id, "room_hole",
           "other rooms stand free within it, and its outline holds them too; its area is too large"});
  }
}

/// Upright layers of equal height as one body; where their faces lie on each other, joined ones would not close.
/// Nullopt for other solids.
std::optional<Solid> one_of_layers(const std::vector<Solid>& solids, double grid_m) {
  constexpr double same = 0.01;
  if (solids.size() < 2) return std::nullopt;
  const Extent first = extent(solids.front());
  std::vector<Polygon2> layers;
  for (const Solid& solid : solids) {
    const Extent box = extent(solid);
    if (std::abs(box.low.z() - first.low.z()) > grid_m || std::abs(box.high.z() - first.high.z()) > grid_m)
      return std::nullopt;
    const Region2 section = body_section(solid, 0.5 * (box.low.z() + box.high.z()));
    const double prism = area(section) * (box.high.z() - box.low.z());
    if (section.size() != 1 || !section.front().holes.empty() || std::abs(prism - volume(solid)) > same * prism ||
        area(footprint(solid)) > (1.0 + same) * area(section))
      return std::nullopt;
    layers.push_back(section.front().outer);
  }
  return extrude(unite(layers), first.low.z(), first.high.z());
}

}  // namespace

Extent extent(const Solid& solid) {
  Extent box{solid.vertices.front(), solid.vertices.front()};
  for (const Eigen::Vector3d& p : solid.vertices) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

std::vector<PolygonWithHoles2> footprint(const Solid& solid) {
  std::vector<Polygon2> triangles;
  for (const Eigen::Vector3i& t : solid.triangles) {
    Polygon2& triangle = triangles.emplace_back();
    for (const int corner : t) triangle.push_back(solid.vertices[static_cast<std::size_t>(corner)].head<2>());
  }
  return unite(triangles);
}

Interpreter::Interpreter(const StepModel& model, const IfcConfig& config) : model_(model), config_(config) {
  building_.warnings = model.skipped;
  for (const StepProduct& product : model.products) products_[product.step_id] = &product;
  for (const StepProduct& product : model.products)
    if (product.whole != 0 && product.whole != product.step_id) parts_[product.whole].push_back(&product);
}

double Interpreter::snapped(double v) const { return snap(v, config_.grid_m); }

void Interpreter::warn(const StepProduct& product, WarningKind kind, const std::string& text) {
  building_.warnings.push_back({product.id, kind, product.type + " #" + std::to_string(product.step_id) + ": " + text});
}

int Interpreter::storey_index(const StepProduct& product, double z0_m) const {
  const auto named = storeys_.find(product.storey);
  std::vector<int> above;
  if (named == storeys_.end()) {
    const StepProduct* own = find(product.storey);  // a level that is left out
    for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
      const auto of = buildings_.find(static_cast<int>(i));
      const bool foreign =
          own != nullptr && own->building != 0 && of != buildings_.end() && of->second != own->building;
      if (!foreign) above.push_back(static_cast<int>(i));
    }
  } else if (const auto uppers = uppers_.find(product.storey); uppers != uppers_.end()) {
    above = uppers->second;
  }
  int index = named != storeys_.end() ? named->second : above.empty() ? 0 : above.front();
  for (const int storey : above)
    if (building_.storeys[static_cast<std::size_t>(storey)].elevation_m <= z0_m + config_.storey_below_m)
      index = storey;
  return index;
}

std::vector<Solid> Interpreter::solids_of(const StepProduct& product) {
  std::vector<Solid> solids;
  for (const Shape& shape : product.body) {
    std::vector<std::string> problems;
    int crossed = 0;
    Solid solid = solid_of(shape, problems, crossed);
    if (crossed > 0)
      warn(product, "geometry", std::to_string(crossed) + " faces run across themselves; what they cover is a guess");
    for (const std::string& problem : problems) warn(product, "not_clipped", problem);
    if (!solid.triangles.empty()) solids.push_back(placed(product.X_WP, std::move(solid)));
  }
  for (const std::string& diagnostic : product.diagnostics) warn(product, "geometry", diagnostic);
  return solids;
}

const StepProduct* Interpreter::find(std::int64_t step_id) const {
  const auto found = products_.find(step_id);
  return found == products_.end() ? nullptr : found->second;
}

bool Interpreter::within(const StepProduct& product, StepClass kind) const {
  for (const StepProduct* at = &product; at != nullptr; at = find(at->whole))
    if (at->kind == kind) return true;
  return false;
}

std::vector<Solid> Interpreter::uncut_solids(const StepProduct& product) {
  std::vector<Solid> solids = solids_of(product);
  const auto parts = parts_.find(product.step_id);
  if (parts == parts_.end()) return solids;
  const bool whole = !solids.empty();
  for (const StepProduct* part : parts->second) {
    if (part->kind != StepClass::part && part->kind != StepClass::obstacle) continue;
    taken_.insert(part->step_id);
    if (whole) continue;
    for (Solid& solid : uncut_solids(*part)) solids.push_back(std::move(solid));
  }
  if (!whole && !solids.empty())
    warn(product, "body_of_parts", "has no body of its own; those of its parts stand for it");
  return solids;
}

Solid Interpreter::layers_of(const StepProduct& product) {
  std::vector<Solid> solids;
  for (const StepProduct* part : parts_.at(product.step_id))
    for (Solid& solid : solids_of(*part)) solids.push_back(std::move(solid));
  if (std::optional<Solid> one = one_of_layers(solids, config_.grid_m)) return std::move(*one);
  return joined(solids);
}

Solid Interpreter::body_of(const StepProduct& product) {
  std::vector<Solid> solids = uncut_solids(product);
  if (solids.empty()) {
    const bool group = !product.has_body && parts_.contains(product.step_id);
    if (!group) warn(product, "no_body", "has no body that can be read, and is left out");
    return {};
  }
  std::vector<Solid> cuts;
  for (const StepProduct* at = &product; at != nullptr; at = find(at->whole)) {
    const auto cutters = cutters_.find(at->step_id);
    if (cutters == cutters_.end()) continue;
    cutters_used_.insert(at->step_id);
    for (const StepProduct* cutter : cutters->second)
      for (Solid& cut : solids_of(*cutter)) cuts.push_back(std::move(cut));
  }
  if (cuts.empty() && product.kind == StepClass::wall && !product.has_body)
    if (std::optional<Solid> wall = one_of_layers(solids, config_.grid_m)) return std::move(*wall);
  if (cuts.empty()) return joined(solids);
  std::vector<std::string> problems;
  for (Solid& solid : solids) solid = without(std::move(solid), cuts, problems);
  for (const std::string& problem : problems) warn(product, "not_cut", problem);
  return joined(solids);
}

void Interpreter::sort_all() {
  const std::vector<int> wall_place = sort_elements(building_.walls);
  for (Opening& opening : building_.openings) opening.wall = wall_place[static_cast<std::size_t>(opening.wall)];
  std::sort(building_.openings.begin(), building_.openings.end(),
            [](const Opening& a, const Opening& b) { return std::tie(a.wall, a.id) < std::tie(b.wall, b.id); });
  sort_elements(building_.rooms);
  sort_elements(building_.slabs);
  sort_elements(building_.columns);
  sort_elements(building_.obstacles);
  std::sort(building_.stairs.begin(), building_.stairs.end(),
            [](const Stair& a, const Stair& b) { return std::tie(a.from, a.id) < std::tie(b.from, b.id); });
  std::sort(building_.warnings.begin(), building_.warnings.end(), [](const Warning& a, const Warning& b) {
    return std::tie(a.element, a.kind, a.text) < std::tie(b.element, b.kind, b.text);
  });
}

void Interpreter::name_by_outlines(const std::vector<NamedPlace>& places, std::vector<Room>& rooms) {
  constexpr double over_floor_m = 1.0;  // of an outline, up or down: half a storey and less
  for (Room& room : rooms) {
    const auto place = std::find_if(places.begin(), places.end(), [&](const NamedPlace& p) {
      return !p.name.empty() && std::abs(room.z0_m - p.z_m) < over_floor_m && room.contains(p.inner);
    });
    if (place == places.end()) continue;
    room.name = place->name;
    placed_.insert(place->space->step_id);
  }
}

void Interpreter::add_missing_rooms(const std::vector<NamedPlace>& places) {
  const std::vector<Room> given = building_.rooms;
  const bool any_space = std::any_of(model_.products.begin(), model_.products.end(), [](const StepProduct& product) {
    return product.kind == StepClass::space && product.space_use == SpaceUse::room;
  });
  const std::string none = any_space ? "no space of the file has a body that can be read" : "the file has no spaces";
  const BoxIndex given_boxes = boxes_of(given);
  std::optional<std::vector<FloorPiece>> floors;  // of the whole building, once it is known that rooms are missing
  for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
    const auto storey = static_cast<int>(i);
    const bool has_rooms =
        std::any_of(given.begin(), given.end(), [&](const Room& room) { return room.storey == storey; });
    // Where others have spaces, a foundation or an attic without them has none on purpose.
    const bool missing = building_.storeys[i].kind == StoreyKind::habitable && has_door(building_, storey);
    if (!given.empty() && (has_rooms || !missing)) continue;
    const bool several = std::any_of(buildings_.begin(), buildings_.end(),
                                     [&](const auto& b) { return !same_building(storey, b.first); });
    if (!several && !floors) floors = floor_pieces(building_);
    std::vector<Room> rooms;
    if (several) {
      const Building own = only_building_of(storey);
      rooms = infer_rooms(own, storey, floor_pieces(own), free_doors_);
    } else {
      rooms = infer_rooms(building_, storey, *floors, free_doors_);
    }
    std::erase_if(rooms, [&](const Room& room) { return is_given(room, given, given_boxes); });
    name_by_outlines(places, rooms);
    if (rooms.empty() && given.empty() && is_built(building_, storey))
      building_.warnings.push_back({building_.storeys[i].id, "no_rooms",
                                    none + ", and walls enclose no room on this storey; no route of rooms goes there"});
    warn_of_enclosed(rooms, given.empty() ? none : "the storey has no spaces", building_);
    building_.rooms.insert(building_.rooms.end(), rooms.begin(), rooms.end());
  }
}

/// Every material that an element names, by name. A name says what is glass; of all else it is not known how it
/// reflects.
void Interpreter::add_materials() {
  std::set<std::string> names;
  for (const Wall& wall : building_.walls) names.insert(wall.material);
  for (const Opening& opening : building_.openings) names.insert(opening.material);
  for (const Slab& slab : building_.slabs) names.insert(slab.material);
  for (const Column& column : building_.columns) names.insert(column.material);
  for (const Stair& stair : building_.stairs) names.insert(stair.material);
  for (const Obstacle& obstacle : building_.obstacles) names.insert(obstacle.material);
  names.erase("");
  for (const std::string& name : names) {
    const auto said = model_.optics.find(name);
    building_.materials.push_back(said == model_.optics.end() ? material_named(name) : said->second);
  }
}

Building Interpreter::finish() {
  set_heights();
  set_storey_kinds(building_);
  // Nothing stands on a roof that the height of its storey would matter to.
  std::erase_if(building_.warnings, [&](const Warning& warning) {
    return warning.kind == "assumed_height" &&
           std::any_of(building_.storeys.begin(), building_.storeys.end(), [&](const Storey& storey) {
             return storey.id == warning.element && storey.kind == StoreyKind::roof;
           });
  });
  std::vector<NamedPlace> places = places_of_outlines();
  add_missing_rooms(places);
  add_rooms_of_outlines(std::move(places));
  warn_of_outlines();
  add_materials();
  warn_of_blocked_doors(building_);
  for (const auto& [host, cutters] : cutters_) {
    if (cutters_used_.contains(host)) continue;
    for (const StepProduct* cutter : cutters)
      warn(*cutter, "opening_unused",
           host == 0 ? "no IfcRelVoidsElement says what it cuts" : "what it should cut has no body");
  }
  sort_all();
  return std::move(building_);
}

}  // namespace plumbline::bim
