// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/faulty_building.h"
#include "scenarios/spec/walk_coverage.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

struct WalkLimits {
  double covered_least = 0.9;  ///< share of the rooms that can be reached by construction, in the worst building
  double plan_large_s = 15.0;  ///< CPU seconds of one core for 300 rooms on 300 x 100 m
  double growth = 1.6;         ///< exponent over the floor's area: the map of it is linear, rooms are not
};

/// Default walks through generated buildings with faults. Two hundred a repetition.
void measure_faulty(const BenchSetting& setting, std::vector<BenchRow>& rows) {
  const auto count = static_cast<std::uint64_t>(setting.repetitions) * 200;
  std::vector<double> covered;
  double buildings = 0.0, refused = 0.0, missed = 0.0, named = 0.0, wrong = 0.0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::optional<FaultyBuilding> faulty = faulty_building(k);
    if (!faulty) continue;
    const FaultyWalk walk = walk_through(*faulty);
    ++buildings;
    missed += static_cast<double>(walk.missed);
    named += static_cast<double>(walk.named);
    if (walk.refused)
      ++refused;
    else
      covered.push_back(static_cast<double>(walk.entered) / static_cast<double>(walk.reachable));
    if (walk.wrong.empty()) continue;
    ++wrong;
    std::fprintf(stderr, "plumbline: %s: %s\n", faulty->what.c_str(), walk.wrong.c_str());
  }
  rows.push_back(make_row("walks.buildings", "number", {buildings}));
  rows.push_back(make_row("walks.refused", "number", {refused}));
  rows.push_back(make_row("walks.rooms_missed", "number", {missed}));
  rows.push_back(
      make_row("walks.rooms_named", "share", {missed > 0.0 ? named / missed : 1.0}, BenchLimit{1.0, false, true}));
  const double least = *std::min_element(covered.begin(), covered.end());
  rows.push_back(
      make_row("walks.covered_least", "share", {least}, BenchLimit{WalkLimits().covered_least, false, true}));
  rows.push_back(make_row("walks.covered", "share", covered));
  rows.push_back(make_row("walks.wrong", "number", {wrong}, BenchLimit{0.0, true, true}));
}

/// CPU seconds to plan the default walk through rows x columns of rooms of 10 x 10 m, and to say what it covers.
double plan_cost(int rows, int columns) {
  Tree options = Tree::map();
  options.set("rows", std::to_string(rows)).set("columns", std::to_string(columns));
  options.set("room_width_m", "10").set("room_depth_m", "10");
  const bim::Building building = bim::read_plan_text(bim::write_plan(bim::generate("grid", options).plan), "grid");
  const slam::Stopwatch watch;
  const sim::MultiStoreyPlanner space(building);
  const RoutePlan plan = plan_route(space, {}, {}, {}, walk_length(default_longest_s, Scenario().speed_mps));
  const WalkCoverage walk = walk_coverage(space, plan);
  return 1e-3 * watch.cpu_ms();
}

void measure_growth(std::vector<BenchRow>& rows) {
  const WalkLimits limits;
  const double small = plan_cost(3, 10), large = plan_cost(10, 30);
  rows.push_back(make_row("walks.plan_30_rooms_s", "s", {small}));
  rows.push_back(make_row("walks.plan_300_rooms_s", "s", {large}, BenchLimit{limits.plan_large_s}));
  rows.push_back(make_row("walks.plan_growth", "power", {growth_exponent(30.0, small, 300.0, large)},
                          BenchLimit{limits.growth, true, true}));
}

}  // namespace

std::vector<BenchRow> bench_walks(const BenchSetting& setting) {
  std::vector<BenchRow> rows;
  measure_growth(rows);
  measure_faulty(setting, rows);
  return rows;
}

}  // namespace plumbline::scenarios
