// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/roundtrip/wall_placement.h"
#include "bim/formats/ifc/step/step_string.h"
#include "bim/formats/ifc/write/write_elements.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

using step::none;
using step::ref;

/// A wall is placed at its start with x along it, since its layers are counted along y. A body that would not survive
/// the turn stays in W, and its layers then say nothing of where they lie.
void ElementWriter::add_walls() {
  for (const Wall& wall : building_.walls) {
    const std::optional<Solid> body_Q = wall.body ? into_placement(wall, *wall.body) : std::nullopt;
    const bool placed = !wall.body || body_Q;
    ShapeWriter shape(document_, "wall");
    ProductText text{"wall", wall.id, wall.name, wall.storey};
    if (placed) {
      text.placement = document_.add_placement(wall.a, wall.direction());
      shape.axis({0.0, 0.0}, {wall.length(), 0.0});
    } else {
      shape.axis(wall.a, wall.b);
    }
    if (wall.body) {
      shape.body({placed ? *body_Q : *wall.body});
    } else {
      shape.body(box_in_placement(wall));
    }
    const int number = document_.add_product("IFCWALL", text, shape.finish(), {step_string(wall.id), ".SOLIDWALL."});
    walls_.push_back(number);
    document_.contain(number, wall.storey);
    add_layers(wall, number, placed);
    add_wall_properties(wall, number, placed);
  }
}

Prism ElementWriter::box_in_placement(const Wall& wall) {
  const double low = wall.offset_m, high = wall.offset_m + wall.thickness_m, end = wall.length();
  return {{{{0.0, low}, {end, low}, {end, high}, {0.0, high}}, {}}, wall.z0_m, wall.z1_m, {0.0, wall.slope}};
}

void ElementWriter::add_wall_properties(const Wall& wall, int product, bool placed) {
  document_.add_properties(product, "Pset_WallCommon",
                           {{"Reference", step::typed("IFCIDENTIFIER", step_string(wall.id))}});
  document_.add_properties(
      product, "Plumbline_Wall",
      {text_property("Id", wall.id), length_property("StartX", wall.a.x()), length_property("StartY", wall.a.y()),
       length_property("EndX", wall.b.x()), length_property("EndY", wall.b.y()),
       length_property("Offset", wall.offset_m), length_property("Bottom", wall.z0_m),
       length_property("Top", wall.z1_m), real_property("Slope", wall.slope),
       flag_property("OwnBody", wall.body.has_value()), flag_property("Placed", placed)});
}

void ElementWriter::add_layers(const Wall& wall, int product, bool placed) {
  StepWriter& out = document_.step();
  const std::optional<int> material = document_.material(wall.material);
  const int layer = out.add("IFCMATERIALLAYER", {material ? ref(*material) : none, step_real(wall.thickness_m), none,
                                                 none, none, none, none});
  int layers = out.add("IFCMATERIALLAYERSET", {step::refs({layer}), none, none});
  if (placed)
    layers =
        out.add("IFCMATERIALLAYERSETUSAGE", {ref(layers), ".AXIS2.", ".POSITIVE.", step_real(wall.offset_m), none});
  document_.relate("IFCRELASSOCIATESMATERIAL", {step::refs({product}), ref(layers)});
}

Prism ElementWriter::across(const Opening& opening, double low_m, double high_m) const {
  const Wall& wall = building_.walls[static_cast<std::size_t>(opening.wall)];
  // A leaning wall has moved aside at the sill.
  const double rise = wall.slope * (opening.z0_m - wall.z0_m);
  Wall piece = wall;
  piece.a = wall.a + (opening.s_m - 0.5 * opening.width_m) * wall.direction() + rise * wall.left();
  piece.b = piece.a + opening.width_m * wall.direction();
  piece.offset_m = low_m;
  piece.thickness_m = high_m - low_m;
  return {{footprint(piece), {}}, opening.z0_m, opening.z1_m, wall.slope * wall.left()};
}

Prism ElementWriter::opening_prism(const Opening& opening) const {
  const Wall& wall = building_.walls[static_cast<std::size_t>(opening.wall)];
  return across(opening, wall.offset_m - config_.overhang_m, wall.offset_m + wall.thickness_m + config_.overhang_m);
}

Prism ElementWriter::leaf_prism(const Opening& opening) const {
  const Wall& wall = building_.walls[static_cast<std::size_t>(opening.wall)];
  const double middle = wall.offset_m + 0.5 * wall.thickness_m;
  const double half = 0.5 * std::min(config_.leaf_m, wall.thickness_m);
  return across(opening, middle - half, middle + half);
}

void ElementWriter::add_openings() {
  filled_.assign(building_.openings.size(), false);
  for (const Opening& opening : building_.openings) {
    const int storey = building_.walls[static_cast<std::size_t>(opening.wall)].storey;
    ShapeWriter shape(document_);
    if (opening.solid) {
      std::vector<Solid> solids{*opening.solid};
      solids.insert(solids.end(), opening.parts.begin(), opening.parts.end());
      shape.body(solids);
    } else {
      shape.body(opening_prism(opening));
    }
    const int number = document_.add_product("IFCOPENINGELEMENT", {"opening", opening.id, opening.id, storey},
                                             shape.finish(), {step_string(opening.id), ".OPENING."});
    openings_.push_back(number);
    const int wall = walls_[static_cast<std::size_t>(opening.wall)];
    document_.relate("IFCRELVOIDSELEMENT", {ref(wall), ref(number)});
    document_.add_properties(
        number, "Plumbline_Opening",
        {text_property("Id", opening.id), text_property("Kind", name_of(opening.kind)),
         length_property("Along", opening.s_m), length_property("Width", opening.width_m),
         length_property("Bottom", opening.z0_m), length_property("Top", opening.z1_m),
         text_property("Leaf", name_of(opening.leaf)), text_property("Material", opening.material),
         text_property("Filling", opening.filling_id), room_property("RoomLeft", opening.rooms[0]),
         room_property("RoomRight", opening.rooms[1]), flag_property("OwnBody", opening.solid.has_value())});
  }
}

int ElementWriter::add_filling(const Opening& opening, int number, int shape) {
  const bool door = opening.kind == OpeningKind::door;
  const int storey = building_.walls[static_cast<std::size_t>(opening.wall)].storey;
  const std::string id = opening.filling_id.empty() ? opening.id : opening.filling_id;
  const double height = opening.z1_m - opening.z0_m;
  const int filling = document_.add_product(
      door ? "IFCDOOR" : "IFCWINDOW", {door ? "door" : "window", id, id, storey}, shape,
      {step_string(id), height > 0.0 ? step_real(height) : none,
       opening.width_m > 0.0 ? step_real(opening.width_m) : none, door ? ".DOOR." : ".WINDOW.", ".NOTDEFINED.", none});
  document_.contain(filling, storey);
  document_.relate("IFCRELFILLSELEMENT", {ref(number), ref(filling)});
  return filling;
}

void ElementWriter::add_fillings() {
  for (std::size_t i = 0; i < building_.openings.size(); ++i) {
    const Opening& opening = building_.openings[i];
    if (filled_[i] || opening.kind == OpeningKind::opening_void) continue;
    ShapeWriter shape(document_, opening.kind == OpeningKind::door ? "door" : "glass");
    if (opening.kind == OpeningKind::window || opening.leaf != Leaf::none) shape.body(leaf_prism(opening));
    const int filling = add_filling(opening, openings_[i], shape.finish());
    document_.assign_material(filling, opening.material);
  }
}

}  // namespace plumbline::bim
