// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario_schema.h"

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view introduction = R"md(# Scenario files

A scenario describes one run: a building, a walk through it, sensors, methods, and the bounds that their scores must
keep. `plumbline run SCENARIO` runs it. `plumbline scenarios --schema` prints this page, which is made from the reader
itself.

- `building` is a [plan](plan.md), an IFC file or any other building that `plumbline inspect` reads, relative to the
  scenario; the examples here belong beside the folder `library`. Methods get it as planned; the robot walks through it
  and the LiDAR sees it as built.
- `doors` and `furniture` change the building for this run, both as planned and as built. `results.json` names a value
  other than the default. A room behind a closed door cannot be reached: the run is refused and the door named.
- `furnish` puts generated furniture into every room, as planned and as built alike. `world: {furniture: ...}` says how
  furniture as built differs from the plan; the seed of the run decides what moves. `plan: {furniture: none}` keeps what
  may have moved from methods. `results.json` names all three, and says what could be known by the building alone and
  with the furniture as planned.
- `start` takes a room, or a point of a storey. `route` takes `rooms` (`all`, or a list) or `shuttle`. Rooms of other
  storeys are reached over stairs that the robot can climb. `all` stays on the start's storey unless `storeys: all`.
- `start: {random: rooms}`, `{random: anywhere}` and `route: {random: 5}` depend on the seed, so that every seed is
  another walk. The run directory's `scenario.yaml` holds the start and the route that were drawn. `anywhere` also draws
  doorways and the ends of stairs, not their landings; there the robot faces its first goal. The rooms that a route
  names can be reached from a drawn place, where there is such a place.
- Only the LiDAR sees `people` and `moving_doors`. The robot does not feel them, and people step aside. No plan holds
  them, and what the LiDAR sees of them does not count as surface of the building. A moving door is open while the robot
  is near it.
- `ground` and `pushes` make walking harder; `results.json` names a value other than the default. Nobody pushes on stairs
  and their landings unless `on_stairs`. A fall ends the run with exit code 4: the scenario failed, not a method.
- `lidar: {preset: harsh}` and `faults: {preset: harsh}` add calibration and environment errors: range errors, dust,
  clocks, mount, IMU, slipping feet. Each size is a key. Methods do not know of them. `results.json` and
  the report name them.
- `plumbline methods` lists the methods; a scenario that names none runs the default ones. A gate has either `max` or
  `min` and bounds one of the [metrics](metrics.md).
- Methods get LiDAR, leg odometry and IMU. `NAME.lidar` in `methods` is the same method with LiDAR alone, and so are
  `NAME.lidar` in gates, files and tables. `sensors: [all, lidar]` runs every method both ways, `sensors: lidar` with
  LiDAR alone. With `[all, lidar]` a method that needs odometry runs once, with all sensors; with `lidar` it is refused.

)md";

}  // namespace

const std::vector<std::string>& scenario_examples() {
  static const std::vector<std::string> examples = {
      R"yaml(scenario: 1
name: example
building: library/house.plan.yaml
doors: as_designed
furniture: true
plan: {furniture: none}
world: {furniture: moved}
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
sensors: [all, lidar]
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
furnish: {density: 0.1, seed: 3, people: 1}
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
)yaml",
      R"yaml(scenario: 1
name: sensors that are wrong
building: library/quickstart.plan.yaml
start: {room: office_a}
route: {rooms: [meeting, office_a]}
duration_s: 60
lidar:
  preset: harsh
  distance_bias_m: 0.04
  reflectivity_bias_m: 0.02
  incidence_bias_m: 0.06
  warm_up_m: 0.03
  warm_up_s: 120
  airborne_per_m: 0.004
faults:
  preset: harsh
  clock_offset_s: -0.02
  clock_jitter_s: 0.004
  mount_error_m: 0.02
  mount_error_deg: 1
  mount_offset_m: [0.01, 0, -0.01]
  mount_rotation_deg: [0, 0.5, 0]
  gyro_bias_radps: 0.005
  accelerometer_bias: 0.05
  imu_scale: 0.01
  slip_mps: 0.5
  slip_s: 0.3
  slip_every_s: 5
)yaml",
      R"yaml(scenario: 1
name: a method of your own
building: library/quickstart.plan.yaml
start: {room: office_a}
route: {rooms: [meeting, office_a]}
duration_s: 60
methods: [vgicp, mine]
processes:
  - name: mine
    command: [python3, my_slam.py, --voxel, "0.3"]
    folder: slam
    plan: false
    repeat: true
    start_s: 60
    scan_s: 2
    finish_s: 300
)yaml"};
  return examples;
}

std::vector<SchemaSection> scenario_schema() { return SchemaVisitor::sections_of<Scenario>(); }

std::string scenario_page() {
  std::string page(introduction);
  for (const std::string& text : scenario_examples()) page += "```yaml\n" + text + "```\n\n";
  return page + "## The file\n\n" + schema_tables(scenario_schema());
}

}  // namespace plumbline::scenarios
