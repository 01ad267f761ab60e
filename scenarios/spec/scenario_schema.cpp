// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario_schema.h"

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view introduction = R"md(# Scenario files

One run: a building, a walk through it, sensors, methods, and the bounds they must keep. `plumbline run SCENARIO` runs it.
This page is what `plumbline scenarios --schema` prints: it is made from the reader itself.

- `building` is a plan ([../bim/PLAN.md](../bim/PLAN.md)), an IFC file or another building that `plumbline inspect`
  reads, relative to the scenario. Methods are given it as planned; the robot walks through and sees it as built.
- `doors` and `furniture` change the building for this run only, as planned and as built; a value off its default is
  named in `results.json`. With closed doors a room behind one cannot be reached: the run is refused and the door named.
- `start` takes a room or a point of a storey; `route` takes `rooms` (`all`, or a list) or `shuttle`. Rooms of other
  storeys are reached over stairs that the robot can climb; `all` stays on the start's storey unless `storeys: all`.
- `start: {random: rooms}` and `route: {random: 5}` are drawn by the seed, so that every seed is another walk; the resolved
  scenario of a run says what was drawn.
- `people` and `moving_doors` are there for the LiDAR only: the robot does not feel them, no plan knows them, and
  what the LiDAR sees of them is not counted as surface of the building. A moving door stands open wherever the robot
  comes near.
- `ground` and `pushes` make walking harder; off their defaults they are named in `results.json`. Nobody pushes on
  stairs and their landings unless `on_stairs`. A fall ends the run with exit code 4: the scenario failed, no method did.
- Methods are listed by `plumbline methods`; none named means all. A gate has either `max` or `min`; its metrics are
  those of `results.json`.

)md";

}  // namespace

const std::vector<std::string>& scenario_examples() {
  static const std::vector<std::string> examples = {
      R"yaml(scenario: 1
name: example
building: library/house.plan.yaml
doors: as_designed
furniture: true
seed: 1
start: {room: living}
route: {rooms: [hall, kitchen, living], loop: 1}
speed_mps: 0.6
duration_s: 120
lidar: {model: vlp16, preset: real}
odometry: {preset: noisy}
ground: {friction: 0.6, uneven_mm: 10}
pushes: {min_n: 40, max_n: 120, every_s: 6, on_stairs: false}
people:
  - {rooms: [kitchen, hall], speed_mps: 0.8}
  - {points: [[2, 1], [4, 1]], radius_m: 0.3, height_m: 1.6}
moving_doors:
  - {door: door_kitchen, hinge: b, swing: right, angle_deg: 100, near_m: 2, travel_s: 1.5, times_s: [20, 35]}
kidnap: {after_s: 60, away_s: 3, to: {room: kitchen}}
prior: {yaw: unknown, storey: known}
methods: [vgicp, s_graphs_plus, s_graph_localization]
gates:
  - {metric: ate_aligned_rmse_m, method: s_graphs_plus, max: 0.05}
  - {metric: rooms.recall, method: s_graphs_plus, min: 0.5}
)yaml",
      R"yaml(scenario: 1
name: there and back
building: library/quickstart.plan.yaml
furniture: false
start: {storey: ground, at: [4, 6], yaw_deg: 90}
route: {shuttle: corridor, times: 2}
kidnap: {after_s: 30, to: {at: [4, 6], yaw_deg: 180}}
lidar:
  model: hdl32e
  preset: full
  returns: dual
  rpm: 1200
  vertical_offsets: false
  range_noise: true
  unit_bias: false
  laser_bias: false
  reflectivity_noise: true
  dropout: true
  optics: true
  footprint: edges
)yaml",
      R"yaml(scenario: 1
name: every room of both storeys
building: library/house.plan.yaml
start: {room: living}
route: {rooms: all, storeys: all}
duration_s: 300
)yaml",
      R"yaml(scenario: 1
name: another walk with every seed
building: library/house.plan.yaml
start: {random: rooms, storey: ground}
route: {random: 5}
duration_s: 90
kidnap: {after_s: 40, to: {random: rooms, storey: ground}}
)yaml"};
  return examples;
}

std::vector<SchemaSection> scenario_schema() { return SchemaVisitor::sections_of<Scenario>(); }

std::string scenario_page() {
  std::string page(introduction);
  std::vector<Tree> examples;
  for (const std::string& text : scenario_examples()) {
    page += "```yaml\n" + text + "```\n\n";
    examples.push_back(read_yaml(text, "example"));
  }
  return page + "## The file\n\n" + schema_tables(scenario_schema(), examples);
}

}  // namespace plumbline::scenarios
