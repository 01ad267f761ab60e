// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_schema.h"

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
  - {id: upper, elevation_m: 3, copy_of: ground}          # walls, openings, rooms, ... once more, as upper/ID
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

A building by hand, in YAML. `plumbline inspect PLAN` says what a plan holds, `plumbline run PLAN` walks through it. This
page is what `plumbline inspect --schema` prints: it is made from the reader itself.

- Lengths are in metres, angles in degrees, counter-clockwise; x and y are those of the plan, z is up.
- Unknown and doubled keys, values out of range, unknown ids, openings that leave their wall or overlap, and rooms cut by
  walls are refused with file, line and column.
- Ids are unique: walls, columns, clutter and stairs together; storeys, openings, rooms and materials each.
- A room's polygon may run along the reference lines of its walls; what walls cover is taken off.
- Every storey gets a floor and a ceiling 0.2 m thick over its walls and rooms. Stairs cut them where less than 2.1 m of
  head room would be left.
- A closed door has a leaf, a window a pane, glass unless it names another material. The LiDAR looks through what lets half
  of the light or more through, save from straight ahead; it stands in the robot's way.
- `deviations` are done one after the other to what was built. Methods are given the plan without them, the robot walks
  through and sees what was built, and scores hold the building as built. Walls that met a moved wall stay where they are.
  A room that its walls no longer enclose is no room as built; rooms that became one are one; a room cut in two is two.

)md";

std::string preset_table() {
  std::string table =
      "## Materials that need no entry\n\n| id | reflectivity | transmission | specular | retro "
      "|\n|---|---|---|---|---|\n";
  for (const Material& material : preset_materials())
    table += "| `" + material.id + "` | " + format_number(material.reflectivity) + " | " +
             format_number(material.transmission) + " | " + format_number(material.specular) + " | " +
             format_number(material.retro) + " |\n";
  return table + "\nRound figures of ours for the light of a LiDAR (905 nm). An entry of the same id goes before.\n";
}

}  // namespace

std::string_view plan_example() { return example; }

std::vector<SchemaSection> plan_schema() { return SchemaVisitor::sections_of<PlanFile>(); }

std::string plan_page() {
  const Tree tree = read_yaml(example, "example");
  return std::string(introduction) + "```yaml\n" + std::string(example) + "```\n\n## The file\n\n" +
         schema_tables(plan_schema(), {tree}) + preset_table();
}

}  // namespace plumbline::bim
