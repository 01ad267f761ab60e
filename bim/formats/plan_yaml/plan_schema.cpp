// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_schema.h"

#include "bim/config/markdown.h"
#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/model/materials.h"

namespace plumbline {

template <>
struct SchemaVariants<bim::PlanDeviationEntry> {
  static constexpr std::size_t count = EnumNames<bim::DeviationOp>::names.size();
  static std::string name(std::size_t i) { return "op: " + std::string(EnumNames<bim::DeviationOp>::names[i]); }
  static bim::PlanDeviationEntry make(std::size_t i) {
    bim::PlanDeviationEntry entry;
    entry.op = static_cast<bim::DeviationOp>(i);
    return entry;
  }
};

}  // namespace plumbline

namespace plumbline::bim {

namespace {

constexpr std::string_view example = R"yaml(plan: 1
name: example
storeys:
  - {id: ground, elevation_m: 0, height_m: 2.8, floor_material: concrete}
  - {id: upper, elevation_m: 3, copy_of: ground}          # its walls, openings, rooms, ... again, as upper/ID
walls:
  - {id: south, storey: ground, a: [0, 0], b: [12, 0], thickness_m: 0.2, just: center, material: brick, height_m: 2.8}
  - {id: east, storey: ground, a: [12, 0], b: [12, 8]}
  - {id: north, storey: ground, a: [12, 8], b: [0, 8]}
  - {id: west, storey: ground, a: [0, 8], b: [0, 0]}
  - {id: partition, storey: ground, a: [7, 0], b: [7, 8], thickness_m: 0.1, material: plaster}
openings:
  - {id: door, wall: partition, kind: door, s_m: 2, width_m: 1, height_m: 2.1, sill_m: 0, leaf: open, material: wood}
  - {id: window, wall: south, kind: window, s_m: 3, width_m: 1.5, height_m: 1.2, sill_m: 0.9}
rooms:
  - {id: hall, storey: ground, polygon: [[0, 0], [7, 0], [7, 8], [0, 8]]}
  - {id: office, storey: ground, polygon: [[7, 0], [12, 0], [12, 8], [7, 8]], walls: [south, east, north, partition]}
columns:
  - {id: post, storey: ground, at: [9.5, 4], size: [0.3, 0.3], yaw_deg: 45, height_m: 2.8, material: concrete}
stairs:
  - {id: stair, from: ground, to: upper, start: [1.5, 5.3], yaw_deg: 0, width_m: 1, rise_m: 0.18, run_m: 0.27,
     landing_after: 9, landing_m: 1.1, turn: back_left, gap_m: 0.1, material: wood}
clutter:
  - {id: desk, storey: ground, shape: box, at: [10.5, 1.5], size: [1.6, 0.8], yaw_deg: 90, height_m: 0.75, material: wood}
  - {id: chair, storey: ground, shape: chair, at: [11.3, 1.5], size: [0.45, 0.45], yaw_deg: -90, height_m: 0.9, material: wood}
  - {id: plant, storey: upper, shape: cylinder, at: [11, 6], size: [0.4, 0.4], height_m: 1.2, material: wood}
materials:
  - {id: brick, reflectivity: 0.35, transmission: 0, specular: 0, retro: 0}
deviations:
  - {op: move_wall, wall: partition, by: [0.2, 0]}
  - {op: remove_wall, wall: upper/partition}
  - {op: add_wall, id: screen, storey: ground, a: [8, 5], b: [11, 5], thickness_m: 0.1, just: left, material: glass, height_m: 2}
  - {op: tilt_wall, wall: east, deg: 0.5}
  - {op: move_opening, opening: door, by_m: 0.3}
  - {op: remove_opening, opening: window}
  - {op: add_opening, id: hatch, wall: partition, kind: door, s_m: 6, width_m: 1, height_m: 2.1, sill_m: 0, leaf: closed, material: metal}
  - {op: add_clutter, id: pallet, storey: ground, shape: cylinder, at: [3, 2], size: [1.2, 0.8], yaw_deg: 10, height_m: 1, material: wood}
  - {op: add_column, id: prop, storey: ground, at: [5, 6], size: [0.1, 0.1], yaw_deg: 0, height_m: 2.8, material: metal}
symmetry:
  exact: false
  group: [{angle_deg: 0, about: [0, 0], from: [ground], to: [upper]}]
  rooms_alike: [[hall, upper/hall], [office, upper/office]]
  feature: {kind: clutter, size_m: 0.4, element: plant, storey: upper, room: upper/office, at: [11, 6], visible_from: [upper/office]}
)yaml";

constexpr std::string_view introduction = R"md(# Plan files

A plan describes a building in YAML. `plumbline inspect PLAN` lists what it holds; `plumbline run PLAN` walks a robot
through it. `plumbline inspect --schema` prints this page, which is made from the reader itself.

- Lengths are in metres, angles in degrees, counter-clockwise. x and y are those of the plan; z points up.
- The reader refuses, with file, line and column: unknown and repeated keys, values out of range, unknown ids, openings
  that overlap or leave their wall, and rooms that a wall cuts.
- Ids are unique among walls, columns, clutter and stairs together, and among storeys, openings, rooms and materials each.
- A room's polygon may follow the reference lines of its walls; the area under the walls is subtracted.
- Every storey gets a floor and a ceiling 0.2 m thick over its walls and rooms. A stair cuts the slabs that leave less
  than 2.1 m of head room.
- A closed door has a leaf. A window has a pane, of glass unless it names another material. The LiDAR sees through a
  material that transmits at least half of the light, except at normal incidence; for the robot it is an obstacle.
- Clutter is a box, a cylinder or a piece of furniture with legs and hollows. Seen along its own y axis its back is
  behind. `plumbline generate furnish` adds furniture to a plan.
- `deviations` make the building as built differ from the plan; they apply in their order. Methods get the plan without
  them. The robot walks through the building as built, the LiDAR sees it, and scores compare with it.
- A wall that met a moved wall stays where it is. As built, a room without closed walls is no room, joined rooms are one
  room, and a divided room is two.

)md";

std::string preset_table() {
  MarkdownTable table({"id", "reflectivity", "transmission", "specular", "retro"});
  for (const Material& material : preset_materials())
    table.add({markdown_code(material.id), format_number(material.reflectivity), format_number(material.transmission),
               format_number(material.specular), format_number(material.retro)});
  return "## Materials without an entry\n\nRounded values for the light of a LiDAR (905 nm). An entry of the same id "
         "replaces one of them.\n\n" +
         table.text();
}

}  // namespace

std::string_view plan_example() { return example; }

std::vector<SchemaSection> plan_schema() { return SchemaVisitor::sections_of<PlanFile>(); }

std::string plan_page() {
  return std::string(introduction) + "```yaml\n" + std::string(example) + "```\n\n## The file\n\n" +
         schema_tables(plan_schema()) + "\n" + preset_table();
}

}  // namespace plumbline::bim
