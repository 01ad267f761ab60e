// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/child.h"
#include "scenarios/localizability/building_map.h"
#include "scenarios/localizability/planned_walk.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

/// CPU seconds of one core; times are targets, for they depend on the machine.
struct IdentifyLimits {
  double duplex_s = 60.0;
  double run_s = 3.0;
  double large_s = 240.0;  ///< the budget of 120 s on two cores, on 300 x 100 m with 300 equal rooms
  double growth = 2.0;     ///< exponent over the number of places: each is compared with all others at a glance
};

/// Both conditions of quickstart's planned walk.
double walk_cost(const BenchSetting& setting) {
  const slam::Stopwatch watch;
  const auto walks = localizability_of_walks(setting.library + "/quickstart.yaml", 1, 1);
  return 0.5e-3 * watch.cpu_ms();
}

/// CPU seconds of the map of a corridor with so many rooms on each side, and its number of places.
std::pair<double, double> map_cost(int rooms) {
  const Tree options = read_yaml("{sides: both, rooms: " + std::to_string(rooms) + "}", "bench");
  const bim::Building plan = bim::read_plan_text(bim::write_plan(bim::generate("corridor", options).plan), "corridor");
  BuildingMapOptions map_options;
  map_options.step_m = 1.0;
  const slam::Stopwatch watch;
  const RunBuilding building(bim::PlannedAndBuilt{plan, plan, {}, true});
  const BuildingMap map = map_of(building, map_options);
  return {static_cast<double>(map.map.cells.size()), 1e-3 * watch.cpu_ms()};
}

/// CPU seconds of one core and step of the map that the default budget allows of 300 equal rooms, each with hundreds of
/// aliases.
std::pair<double, double> large_map() {
  const Tree options = read_yaml("{rows: 10, columns: 30, room_width_m: 10, room_depth_m: 10}", "bench");
  const bim::Building plan = bim::read_plan_text(bim::write_plan(bim::generate("grid", options).plan), "grid");
  BuildingMapOptions map_options;
  map_options.budget_s = 120.0;
  const slam::Stopwatch watch;
  const RunBuilding building(bim::PlannedAndBuilt{plan, plan, {}, true});
  const BuildingMap map = map_of(building, map_options);
  return {map.options.step_m, 1e-3 * watch.cpu_ms()};
}

}  // namespace

std::vector<BenchRow> bench_identify(const BenchSetting& setting) {
  const IdentifyLimits limits;
  std::vector<BenchRow> rows;
  const std::string duplex = setting.data_dir + "/ifc/duplex.ifc";
  if (setting.data_dir.empty() || !std::filesystem::exists(duplex)) {
    std::fprintf(stderr, "plumbline: no ifc/duplex.ifc in --data: its row is left out\n");
  } else {
    rows.push_back(
        make_row("identify.duplex_s", "s", {run_self({"identify", duplex}).cpu_s}, BenchLimit{limits.duplex_s}));
  }
  std::vector<double> runs;
  for (int k = 0; k < setting.repetitions; ++k) {
    setting.step();
    runs.push_back(walk_cost(setting));
  }
  rows.push_back(make_row("identify.run_s", "s", runs, BenchLimit{limits.run_s}));
  const auto [step_m, large_s] = large_map();
  rows.push_back(make_row("identify.map_300_rooms_step_m", "m", {step_m}));
  rows.push_back(make_row("identify.map_300_rooms_s", "s", {large_s}, BenchLimit{limits.large_s}));
  const auto [few, before] = map_cost(3);
  const auto [many, after] = map_cost(9);
  rows.push_back(make_row("identify.map_3_rooms_s", "s", {before}));
  rows.push_back(make_row("identify.map_9_rooms_s", "s", {after}));
  rows.push_back(make_row("identify.growth", "power", {growth_exponent(few, before, many, after)},
                          BenchLimit{limits.growth, true, true}));
  return rows;
}

}  // namespace plumbline::scenarios
