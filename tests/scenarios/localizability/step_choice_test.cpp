// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/step_choice.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "scenarios/localizability/building_map.h"
#include "scenarios/localizability/localizability_map.h"
#include "tests/data.h"

namespace plumbline::scenarios {
namespace {

TEST(StepChoice, TakesTheFinestStepThatFits) {
  const MapWork coarse{4.0, 200, 100'000'000};
  EXPECT_EQ(finest_step(coarse, 1e12, 0.5), 0.7);  // at 0.5 m there would be 12,800 places
  EXPECT_EQ(finest_step({4.0, 100, 100'000'000}, 1e12, 0.5), 0.5);
  EXPECT_EQ(finest_step(coarse, 0.0, 0.5), 4.0);
  double last = 0.0;
  for (double beams = 1e11; beams > 1e8; beams *= 0.8) {
    const double step = finest_step(coarse, beams, 0.5);
    EXPECT_GE(step, last);
    EXPECT_TRUE(step == coarse.step_m || expected_beams(coarse, step) <= beams);
    last = step;
  }
  EXPECT_GT(last, 1.0);
}

TEST(StepChoice, TheCoarseMapIsSmallAndNeverFinerThanAsked) {
  EXPECT_EQ(coarse_step(5.0, 0.5), 0.5);
  EXPECT_EQ(coarse_step(50.0, 2.0), 2.0);
  for (const double area : {100.0, 1e3, 1e4, 3e4}) {
    const double step = coarse_step(area, 0.5);
    EXPECT_LE(area / (step * step), StepBudget().coarse_places);
    EXPECT_GT(2.1 * area / (step * step), StepBudget().coarse_places);
  }
}

TEST(StepChoice, GrowthIsThePowerBetweenTwoMaps) {
  EXPECT_NEAR(growth_between({4.0, 100, 1'000'000}, {2.0, 400, 8'000'000}), 1.5, 1e-12);
  EXPECT_EQ(growth_between({4.0, 100, 1'000'000}, {2.0, 400, 2'000'000}), 1.0);
  EXPECT_EQ(growth_between({4.0, 100, 1'000}, {2.0, 400, 1'000'000'000}), 2.0);
  EXPECT_EQ(growth_between({4.0, 0, 0}, {2.0, 400, 10}), StepBudget().growth);
}

// 24 equal rooms, where each place has dozens of aliases: even there a map takes what was expected of it, or less.
TEST(StepChoice, AMapStaysWithinItsBudget) {
  Tree options = Tree::map();
  options.set("rows", "4").set("columns", "6");
  const bim::Building plan = bim::read_plan_text(bim::write_plan(bim::generate("grid", options).plan), "grid");
  const RunBuilding building(bim::PlannedAndBuilt{plan, plan, {}, true});
  const double core_s = 2.0 * StepBudget().beams_per_core_s;
  double coarser = 100.0;
  for (const double budget_s : {1.0, 2.0, 4.0}) {
    BuildingMapOptions choice;
    choice.step_m = 0.5;
    choice.budget_s = budget_s;
    const BuildingMap map = map_of(building, choice);
    EXPECT_LE(static_cast<double>(map.map.beams), budget_s * core_s) << budget_s;
    EXPECT_LE(map.options.step_m, coarser) << budget_s;
    coarser = map.options.step_m;
  }
  EXPECT_LT(coarser, 8.0);
}

TEST(StepChoice, TheWorkOfAMapIsCountedAlikeWhateverTheThreads) {
  const bim::PlannedAndBuilt site = bim::load_planned_and_built(project_file("scenarios/library/quickstart.plan.yaml"));
  const RunBuilding building(site);
  BuildingMapOptions options;
  options.step_m = 1.5;
  std::vector<std::uint64_t> beams;
  for (const int threads : {1, 2}) {
    options.threads = threads;
    beams.push_back(map_of(building, options).map.beams);
  }
  EXPECT_GT(beams[0], 0U);
  EXPECT_EQ(beams[0], beams[1]);
}

TEST(StepChoice, ABudgetChoosesAStepAndTheMapIsTheOneOfThatStep) {
  const bim::PlannedAndBuilt site = bim::load_planned_and_built(project_file("scenarios/library/quickstart.plan.yaml"));
  const RunBuilding building(site);
  BuildingMapOptions options;
  options.step_m = 1.0;
  options.budget_s = 5.0;
  const BuildingMap chosen = map_of(building, options);
  EXPECT_GE(chosen.options.step_m, 1.0);
  BuildingMapOptions exact;
  exact.step_m = chosen.options.step_m;
  const BuildingMap same = map_of(building, exact);
  ASSERT_EQ(chosen.map.cells.size(), same.map.cells.size());
  for (std::size_t i = 0; i < same.map.cells.size(); ++i) {
    EXPECT_EQ(chosen.map.cells[i].compass.aliases, same.map.cells[i].compass.aliases);
    EXPECT_EQ(chosen.map.cells[i].compass.walk_m, same.map.cells[i].compass.walk_m);
  }
}

}  // namespace
}  // namespace plumbline::scenarios
