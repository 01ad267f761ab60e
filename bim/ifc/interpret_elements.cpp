// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "bim/geometry/polygon_boolean.h"
#include "bim/ifc/interpret.h"
#include "bim/ifc/shape.h"

namespace plumbline::bim {
namespace {

/// The largest piece of an outline; of equal ones the first in canonical order.
const PolygonWithHoles2& largest(const std::vector<PolygonWithHoles2>& pieces) {
  return *std::max_element(pieces.begin(), pieces.end(), [](const PolygonWithHoles2& a, const PolygonWithHoles2& b) {
    return signed_area(a.outer) < signed_area(b.outer);
  });
}

struct ObstacleKind {
  StepClass kind;
  std::string_view name;
};
constexpr std::array<ObstacleKind, 7> obstacle_kinds{{{StepClass::stair, "stair"},
                                                      {StepClass::railing, "railing"},
                                                      {StepClass::beam, "beam"},
                                                      {StepClass::member, "member"},
                                                      {StepClass::plate, "plate"},
                                                      {StepClass::covering, "covering"},
                                                      {StepClass::footing, "footing"}}};

}  // namespace

void Interpreter::add_rooms() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::space) continue;
    const Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    const std::vector<PolygonWithHoles2> outline = footprint(body);
    if (outline.empty()) {
      warn(product, "no_body", "has no area on the plan, and is left out");
      continue;
    }
    if (outline.size() > 1) warn(product, "room_pieces", "its outline has several pieces; the largest is the room");
    const PolygonWithHoles2& piece = largest(outline);
    if (!piece.holes.empty()) warn(product, "room_hole", "holes of its outline are filled");
    Room room;
    room.id = product.id;
    room.name = product.name;
    room.step_id = product.step_id;
    room.polygon = piece.outer;
    const Extent box = extent(body);
    room.z0_m = snapped(box.low.z());
    room.z1_m = snapped(box.high.z());
    room.storey = storey_index(product, room.z0_m);
    building_.rooms.push_back(std::move(room));
  }
}

void Interpreter::add_slabs() {
  for (const StepProduct& product : model_.products) {
    const bool roof = product.kind == StepClass::roof && !product.body.empty();
    if (product.kind != StepClass::slab && !roof) continue;
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    if (const auto cuts = slab_openings_.find(product.step_id); cuts != slab_openings_.end()) {
      std::vector<std::string> problems;
      body = without(std::move(body), cuts->second, problems);
      for (const std::string& problem : problems) warn(product, "not_cut", problem);
    }
    const std::vector<PolygonWithHoles2> outline = footprint(body);
    if (outline.empty()) {
      warn(product, "no_body", "has no area on the plan, and is left out");
      continue;
    }
    Slab slab;
    slab.id = product.id;
    slab.step_id = product.step_id;
    slab.polygon = largest(outline);
    const Extent box = extent(body);
    slab.z0_m = snapped(box.low.z());
    slab.z1_m = snapped(box.high.z());
    slab.storey = storey_index(product, slab.z0_m);
    slab.body = std::move(body);
    building_.slabs.push_back(std::move(slab));
  }
}

void Interpreter::add_columns() {
  for (const StepProduct& product : model_.products) {
    if (product.kind != StepClass::column) continue;
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    Column column;
    column.id = product.id;
    column.step_id = product.step_id;
    const std::vector<PolygonWithHoles2> outline = footprint(body);
    if (!outline.empty()) column.footprint = largest(outline).outer;
    const Extent box = extent(body);
    column.z0_m = snapped(box.low.z());
    column.z1_m = snapped(box.high.z());
    column.storey = storey_index(product, column.z0_m);
    column.body = std::move(body);
    building_.columns.push_back(std::move(column));
  }
}

void Interpreter::add_obstacles() {
  for (const StepProduct& product : model_.products) {
    if (product.kind == StepClass::furniture || product.kind == StepClass::proxy) {
      warn(product, "left_out", "furniture and proxies are not part of the shell");
      continue;
    }
    const auto kind = std::find_if(obstacle_kinds.begin(), obstacle_kinds.end(),
                                   [&](const ObstacleKind& k) { return k.kind == product.kind; });
    // A stair may be a mere group of flights, which stand for themselves.
    if (kind == obstacle_kinds.end() || product.body.empty()) continue;
    Solid body = body_of(product);
    if (body.triangles.empty()) continue;
    Obstacle obstacle;
    obstacle.id = product.id;
    obstacle.step_id = product.step_id;
    obstacle.kind = kind->name;
    obstacle.storey = storey_index(product, extent(body).low.z());
    obstacle.body = std::move(body);
    building_.obstacles.push_back(std::move(obstacle));
  }
}

}  // namespace plumbline::bim
