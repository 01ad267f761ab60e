// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/write_elements.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "bim/formats/ifc/step/step_string.h"
#include "bim/mesh/palette.h"

namespace plumbline::bim {

using step::none;
using step::ref;

namespace {

struct ObstacleClass {
  std::string_view kind;
  const char* type;
  const char* predefined;
};
/// Kinds of obstacles and what they are called in IFC; all else is a proxy.
constexpr std::array<ObstacleClass, 12> obstacle_classes{{{"beam", "IFCBEAM", "$"},
                                                          {"box", "IFCFURNITURE", "$"},
                                                          {"covering", "IFCCOVERING", "$"},
                                                          {"curtain_panel", "IFCPLATE", ".CURTAIN_PANEL."},
                                                          {"cylinder", "IFCFURNITURE", "$"},
                                                          {"footing", "IFCFOOTING", "$"},
                                                          {"furniture", "IFCFURNITURE", "$"},
                                                          {"member", "IFCMEMBER", "$"},
                                                          {"mullion", "IFCMEMBER", ".MULLION."},
                                                          {"plate", "IFCPLATE", "$"},
                                                          {"railing", "IFCRAILING", "$"},
                                                          {"roof", "IFCROOF", "$"}}};
constexpr ObstacleClass proxy{"", "IFCBUILDINGELEMENTPROXY", "$"};

const ObstacleClass& class_of(const std::string& kind) {
  const auto* found = std::find_if(obstacle_classes.begin(), obstacle_classes.end(),
                                   [&](const ObstacleClass& known) { return known.kind == kind; });
  return found == obstacle_classes.end() ? proxy : *found;
}

}  // namespace

StepProperty ElementWriter::room_property(const std::string& name, int room) const {
  return text_property(name, room < 0 ? "" : document_.global_id_of(rooms_.at(static_cast<std::size_t>(room))));
}

StepProperty ElementWriter::storey_property(const std::string& name, int storey) const {
  return text_property(name, storey < 0 ? "" : document_.storey_global_id(storey));
}

void ElementWriter::add_rooms() {
  for (const Room& room : building_.rooms) {
    const PolygonWithHoles2 outline = room.outline();
    const int shape = ShapeWriter(document_).footprint(outline).body(Prism{outline, room.z0_m, room.z1_m}).finish();
    const int number = document_.add_product("IFCSPACE", {"space", room.id, room.name, room.storey}, shape,
                                             {none, ".ELEMENT.", ".INTERNAL.", step_real(room.z0_m)});
    rooms_.push_back(number);
    document_.decompose(number, room.storey);
    document_.add_properties(
        number, "Plumbline_Space",
        {text_property("Id", room.id), length_property("Floor", room.z0_m), length_property("Ceiling", room.z1_m)});
  }
}

void ElementWriter::add_boundaries() {
  std::vector<int> bounds(building_.walls.size(), 0);
  for (const Room& room : building_.rooms)
    for (const int wall : room.walls) ++bounds[static_cast<std::size_t>(wall)];
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    const Room& room = building_.rooms[i];
    for (const int wall : room.walls) {
      const auto at = static_cast<std::size_t>(wall);
      document_.relate("IFCRELSPACEBOUNDARY", {ref(rooms_[i]), ref(walls_[at]), none, ".PHYSICAL.",
                                               bounds[at] > 1 ? ".INTERNAL." : ".NOTDEFINED."});
    }
    int count = 0;
    for (const VirtualEdge& edge : room.virtual_edges) add_virtual_edge(room, rooms_[i], edge, ++count);
  }
}

void ElementWriter::add_virtual_edge(const Room& room, int space, const VirtualEdge& edge, int count) {
  const int shape = ShapeWriter(document_).axis(edge.a, edge.b).finish();
  const std::string name = room.id + "/open" + std::to_string(count);
  const int number = document_.add_product("IFCVIRTUALELEMENT", {"virtual", name, name, room.storey}, shape, {none});
  document_.contain(number, room.storey);
  std::vector<StepProperty> properties = {room_property("Beyond", edge.room)};
  if (!edge.door.empty()) properties.push_back(text_property("Door", edge.door));
  document_.add_properties(number, "Plumbline_VirtualEdge", properties);
  document_.relate("IFCRELSPACEBOUNDARY",
                   {ref(space), ref(number), none, ".VIRTUAL.", edge.room < 0 ? ".NOTDEFINED." : ".INTERNAL."});
}

void ElementWriter::add_slabs() {
  for (const Slab& slab : building_.slabs) {
    ShapeWriter shape(document_, "slab");
    shape.footprint(slab.polygon);
    if (slab.body) {
      shape.body({*slab.body});
    } else {
      shape.body(Prism{slab.polygon, slab.z0_m, slab.z1_m});
    }
    const int number = document_.add_product("IFCSLAB", {"slab", slab.id, slab.id, slab.storey}, shape.finish(),
                                             {step_string(slab.id), ".FLOOR."});
    document_.contain(number, slab.storey);
    document_.assign_material(number, slab.material);
    document_.add_properties(number, "Plumbline_Slab",
                             {text_property("Id", slab.id), length_property("Bottom", slab.z0_m),
                              length_property("Top", slab.z1_m), flag_property("OwnBody", slab.body.has_value())});
  }
}

void ElementWriter::add_columns() {
  for (const Column& column : building_.columns) {
    const PolygonWithHoles2 outline{column.footprint, {}};
    ShapeWriter shape(document_, "column");
    shape.footprint(outline);
    if (column.body) {
      shape.body({*column.body});
    } else {
      shape.body(Prism{outline, column.z0_m, column.z1_m});
    }
    const int number = document_.add_product("IFCCOLUMN", {"column", column.id, column.id, column.storey},
                                             shape.finish(), {step_string(column.id), ".COLUMN."});
    document_.contain(number, column.storey);
    document_.assign_material(number, column.material);
    document_.add_properties(number, "Plumbline_Column",
                             {text_property("Id", column.id), length_property("Bottom", column.z0_m),
                              length_property("Top", column.z1_m), flag_property("OwnBody", column.body.has_value())});
  }
}

int ElementWriter::opening_of(const Obstacle& obstacle) const {
  const bool leaf = obstacle.kind == "door_leaf", pane = obstacle.kind == "window_pane";
  for (std::size_t i = 0; i < building_.openings.size() && (leaf || pane); ++i) {
    const Opening& opening = building_.openings[i];
    const bool fits = (leaf && opening.kind == OpeningKind::door) || (pane && opening.kind == OpeningKind::window);
    if (fits && !filled_[i] && obstacle.id.starts_with(opening.id + "/")) return static_cast<int>(i);
  }
  return -1;
}

void ElementWriter::add_obstacles() {
  for (const Obstacle& obstacle : building_.obstacles) {
    const int shape = ShapeWriter(document_, colour_of(obstacle)).body({obstacle.body}).finish();
    const int opening = opening_of(obstacle);
    int number = 0;
    if (opening >= 0) {
      const auto at = static_cast<std::size_t>(opening);
      number = add_filling(building_.openings[at], openings_[at], shape);
      filled_[at] = true;
    } else {
      const ObstacleClass& known = class_of(obstacle.kind);
      number = document_.add_product(known.type, {"obstacle", obstacle.id, obstacle.id, obstacle.storey, obstacle.kind},
                                     shape, {step_string(obstacle.id), known.predefined});
      document_.contain(number, obstacle.storey);
    }
    document_.assign_material(number, obstacle.material);
    document_.add_properties(number, "Plumbline_Obstacle",
                             {text_property("Id", obstacle.id), text_property("Kind", obstacle.kind),
                              storey_property("Storey", obstacle.storey), flag_property("Planned", obstacle.planned)});
  }
}

}  // namespace plumbline::bim
