// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/bench_stairs.h"

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/random/stream.h"
#include "sim/route/multi_storey_planner.h"
#include "sim/route/pure_pursuit.h"

namespace plumbline::scenarios {

namespace {

/// Two storeys of one room; the stair is to be added.
constexpr const char* stairwell = R"(plan: 1
name: stairwell
storeys: [{id: ground, elevation_m: 0, height_m: 2.6}, {id: upper, elevation_m: 2.8, height_m: 2.6}]
walls:
  - {id: south, storey: ground, a: [0, 0], b: [10, 0], thickness_m: 0.2, just: right}
  - {id: east, storey: ground, a: [10, 0], b: [10, 5], thickness_m: 0.2, just: right}
  - {id: north, storey: ground, a: [10, 5], b: [0, 5], thickness_m: 0.2, just: right}
  - {id: west, storey: ground, a: [0, 5], b: [0, 0], thickness_m: 0.2, just: right}
  - {id: upper_south, storey: upper, a: [0, 0], b: [10, 0], thickness_m: 0.2, just: right}
  - {id: upper_east, storey: upper, a: [10, 0], b: [10, 5], thickness_m: 0.2, just: right}
  - {id: upper_north, storey: upper, a: [10, 5], b: [0, 5], thickness_m: 0.2, just: right}
  - {id: upper_west, storey: upper, a: [0, 5], b: [0, 0], thickness_m: 0.2, just: right}
rooms:
  - {id: hall, storey: ground, polygon: [[0, 0], [10, 0], [10, 5], [0, 5]]}
  - {id: gallery, storey: upper, polygon: [[0, 0], [10, 0], [10, 5], [0, 5]]}
stairs:
)";

struct Case {
  const char* name;
  const char* stair;    ///< entry of the plan
  Eigen::Vector2d top;  ///< goal on the upper storey
};

/// The gentle one has 18 risers of 15.6 cm in one flight, the steep one 15 of 18.7 cm with a turn on a landing.
const Case cases[] = {
    {"gentle",
     "  - {id: stair, from: ground, to: upper, start: [2.5, 2.5], width_m: 1.0, rise_m: 0.16, run_m: 0.30}\n",
     {9.0, 4.2}},
    {"steep",
     "  - {id: stair, from: ground, to: upper, start: [5.0, 1.6], width_m: 0.9, rise_m: 0.19, run_m: 0.25,\n"
     "     landing_after: 8, landing_m: 0.85, turn: back_left, gap_m: 0.1}\n",
     {2.0, 2.6}},
};

struct WalkConfig {
  Eigen::Vector2d start_W{1.3, 2.5};
  double start_off_m = 0.15;  ///< uniform to all sides
  double start_turned = 0.1;  ///< rad
  double seconds = 150.0;     ///< a walk takes about 80
  double push_min_n = 60.0;   ///< one every 6 s
  double push_max_n = 150.0;
};

/// Seconds a walk takes, or nothing when the robot falls, stalls or does not come back in time.
std::optional<double> walk(const bim::Building& building, const std::vector<sim::Waypoint>& way,
                           const WalkConfig& config, const sim::Conditions& conditions, std::uint64_t seed) {
  constexpr double step_s = 1e-9 * static_cast<double>(sim::Robot::step_ns);
  const std::vector<int> storeys = {0, 1};
  const Stream stream(seed, "bim.generate");
  const auto draw = [&](std::uint32_t lane, double size) { return size * (2.0 * stream.uniform(0, lane) - 1.0); };
  const Eigen::Vector3d start_W(config.start_W.x() + draw(0, config.start_off_m),
                                config.start_W.y() + draw(1, config.start_off_m), 1.0);
  try {
    sim::Robot robot(Pose::from_xyz_yaw(start_W, draw(2, config.start_turned)), sim::building_ground(building, storeys),
                     sim::collision_boxes(building, storeys), conditions, seed);
    sim::PurePursuit pursuit(sim::PurePursuitConfig{}, way, seed);
    while (!pursuit.done()) {
      if (static_cast<double>(robot.steps()) * step_s > config.seconds) return std::nullopt;
      robot.step(pursuit.update(robot.X_WR(), robot.steps()));
    }
    return static_cast<double>(robot.steps()) * step_s;
  } catch (const ScenarioFailure&) {
    return std::nullopt;
  }
}

std::vector<sim::Waypoint> up_and_down(const bim::Building& building, const Case& c, const WalkConfig& config) {
  const sim::MultiStoreyPlanner space(building);
  const sim::FloorPoint bottom{0, config.start_W};
  const sim::FloorPoint top{1, c.top};
  std::vector<sim::Waypoint> way = space.path(bottom, top);
  const std::vector<sim::Waypoint> back = space.path(top, bottom);
  if (way.empty() || back.empty()) throw InternalError(std::string("bench: no way over the stair '") + c.name + "'");
  way.insert(way.end(), back.begin() + 1, back.end());
  return way;
}

}  // namespace

std::vector<BenchRow> bench_stairs(const BenchSetting& setting) {
  const WalkConfig config;
  std::vector<BenchRow> rows;
  for (const Case& c : cases) {
    const bim::Building building = bim::read_plan_text(std::string(stairwell) + c.stair, "stairwell");
    const std::vector<sim::Waypoint> way = up_and_down(building, c, config);
    for (const bool pushed : {false, true}) {
      sim::Conditions conditions;
      if (pushed) conditions.pushes = {.min_n = config.push_min_n, .max_n = config.push_max_n, .on_stairs = true};
      const int seeds = pushed ? (setting.repetitions + 1) / 2 : setting.repetitions;
      std::vector<double> times;
      for (int seed = 1; seed <= seeds; ++seed) {
        setting.step();
        if (const auto seconds = walk(building, way, config, conditions, static_cast<std::uint64_t>(seed)))
          times.push_back(*seconds);
      }
      const std::string name = std::string("legs.stairs_") + c.name + (pushed ? "_pushed" : "");
      const auto failures = static_cast<double>(seeds) - static_cast<double>(times.size());
      const std::string of = "of " + std::to_string(seeds);
      // Scenarios hold pushes off on stairs, since not all of them are survived.
      rows.push_back(pushed ? make_row(name + "_failures", of, {failures})
                            : make_row(name + "_failures", of, {failures},
                                       BenchLimit{.value = 0.0, .at_most = true, .gates = true}));
      if (!times.empty()) rows.push_back(make_row(name + "_s", "s", times));
    }
  }
  return rows;
}

}  // namespace plumbline::scenarios
