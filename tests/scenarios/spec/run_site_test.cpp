// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/run_site.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/model/permanence.h"
#include "scenarios/spec/run_building.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

std::string house() { return project_file("scenarios/library/house.plan.yaml"); }

Scenario with(const std::string& more) {
  return read_scenario("scenario: 1\nbuilding: house.plan.yaml\nseed: 7\n" + more, "s.yaml").scenario;
}

std::size_t movables(const bim::Building& building) {
  return static_cast<std::size_t>(
      std::count_if(building.obstacles.begin(), building.obstacles.end(), bim::may_have_moved));
}

std::size_t solids(const bim::Plan& plan, const bim::Building& building) {
  return static_cast<std::size_t>(std::count_if(plan.solids.begin(), plan.solids.end(), [&](const bim::PlanSolid& s) {
    return std::any_of(building.obstacles.begin(), building.obstacles.end(),
                       [&](const bim::Obstacle& o) { return o.id == s.id && bim::may_have_moved(o); });
  }));
}

TEST(RunSite, IsTheFilesBuildingUnlessTheScenarioSaysOtherwise) {
  const bim::PlannedAndBuilt site = load_site(house(), with(""));
  EXPECT_EQ(site.as_planned.obstacles.size(), site.as_built.obstacles.size());
  EXPECT_TRUE(site.changes.empty());
}

// The robot stands on a floor that the file does not have, so that the LiDAR sees it; methods are told of none.
TEST(RunSite, AFloorThatTheRobotStandsOnIsSeen) {
  bim::Building walls = load_site(project_file("scenarios/library/quickstart.plan.yaml"), with("")).as_planned;
  ASSERT_TRUE(walls.stairs.empty());
  walls.slabs.clear();
  walls.rooms.clear();
  walls.openings.clear();
  const Folder folder;
  std::ofstream(folder / "walls.ifc") << bim::write_ifc(walls);
  const RunBuilding building(load_site(folder / "walls.ifc", with("")));
  EXPECT_FALSE(building.deviates());
  EXPECT_TRUE(building.as_planned().slabs.empty());
  ASSERT_EQ(building.as_built().slabs.size(), 1U);
  EXPECT_EQ(building.mesh_as_built().elements.size(), building.mesh_as_planned().elements.size() + 1);
}

TEST(RunSite, SaysHowManyOfThePeopleSit) {
  const auto said = [](const std::string& people) {
    const bim::PlannedAndBuilt site = load_site(house(), with("furnish: {density: 0.2, people: " + people + "}\n"));
    return std::any_of(site.as_planned.warnings.begin(), site.as_planned.warnings.end(),
                       [](const bim::Warning& warning) { return warning.kind == "few_chairs"; });
  };
  EXPECT_FALSE(said("1"));
  EXPECT_TRUE(said("50"));
}

TEST(RunSite, FurnitureIsAddedAsPlannedAndAsBuilt) {
  const bim::PlannedAndBuilt bare = load_site(house(), with(""));
  const bim::PlannedAndBuilt site = load_site(house(), with("furnish: {density: 0.15, seed: 3}\n"));
  EXPECT_GT(movables(site.as_planned), movables(bare.as_planned) + 3);
  EXPECT_EQ(movables(site.as_planned), movables(site.as_built));
  EXPECT_TRUE(site.changes.empty());
  EXPECT_FALSE(RunBuilding(site).deviates());
}

TEST(RunSite, AnotherWorldIsBuiltOtherwiseAndSaysSo) {
  for (const char* world : {"moved", "swapped", "more", "unknown"}) {
    const Scenario scenario =
        with("furnish: {density: 0.15, seed: 3}\nworld: {furniture: " + std::string(world) + "}\n");
    const bim::PlannedAndBuilt site = load_site(house(), scenario);
    EXPECT_FALSE(site.changes.empty()) << world;
    const RunBuilding building(site);
    EXPECT_TRUE(building.deviates()) << world;
    EXPECT_NE(&building.mesh_as_planned(), &building.mesh_as_built()) << world;
    EXPECT_EQ(site.as_planned.obstacles.size(),
              load_site(house(), with("furnish: {density: 0.15, seed: 3}\n")).as_planned.obstacles.size());
    for (const bim::Change& change : site.changes) {
      const auto has = [&](const bim::Building& b) {
        return std::any_of(b.obstacles.begin(), b.obstacles.end(),
                           [&](const bim::Obstacle& o) { return o.id == change.element; });
      };
      EXPECT_EQ(has(site.as_planned), change.op != "add_furniture") << world << " " << change.element;
      EXPECT_EQ(has(site.as_built), change.op != "remove_furniture") << world << " " << change.element;
    }
  }
}

TEST(RunSite, TheSeedDecidesWhatMoves) {
  const std::string moved = "furnish: {density: 0.15, seed: 3}\nworld: {furniture: moved}\n";
  Scenario scenario = with(moved);
  const auto corner = [&] {
    std::vector<Eigen::Vector3d> corners;
    for (const bim::Obstacle& o : load_site(house(), scenario).as_built.obstacles)
      corners.push_back(o.body.vertices.front());
    return corners;
  };
  const std::vector<Eigen::Vector3d> once = corner();
  EXPECT_TRUE(once == corner());
  scenario.seed = 8;
  EXPECT_FALSE(once == corner());
}

TEST(RunSite, MethodsAreToldTheWholePlanOrItsBuilding) {
  const bim::PlannedAndBuilt site = load_site(house(), with(""));
  const RunBuilding whole(site), bare(site, ToldFurniture::none);
  EXPECT_TRUE(whole.plans_movables());
  EXPECT_GT(solids(*whole.plan_as_planned(), site.as_planned), 0U);
  EXPECT_EQ(solids(*bare.plan_as_planned(), site.as_planned), 0U);
  EXPECT_FALSE(whole.plan_as_planned()->furniture.triangles.empty());
  EXPECT_TRUE(bare.plan_as_planned()->furniture.triangles.empty());
  EXPECT_EQ(bare.plan_as_planned()->faces.size(), whole.plan_as_planned()->faces.size());
  EXPECT_EQ(bare.plan_as_built().solids.size(), whole.plan_as_built().solids.size());
}

TEST(RunSite, AreNamedAmongWhatIsNotAsUsual) {
  const std::vector<std::string> off = off_defaults(
      with("furnish: {density: 0.2, seed: 4, people: 2}\nplan: {furniture: none}\nworld: {furniture: more}\n"));
  EXPECT_EQ(off, (std::vector<std::string>{"furnish.density: 0.2", "furnish.seed: 4", "furnish.people: 2",
                                           "plan.furniture: none", "world.furniture: more"}));
  EXPECT_TRUE(off_defaults(with("plan: {furniture: as_planned}\n")).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
