// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/deviation_list.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/report/deviation_sight.h"

namespace plumbline::scenarios {
namespace {

bim::PlannedAndBuilt site_of(const std::string& deviations) {
  const std::string plan =
      "plan: 1\n"
      "storeys: [{id: g, height_m: 3}, {id: up, elevation_m: 3.2, height_m: 3}]\n"
      "walls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [8, 0]}\n"
      "  - {id: e, storey: g, a: [8, 0], b: [8, 5]}\n"
      "  - {id: n, storey: g, a: [8, 5], b: [0, 5]}\n"
      "  - {id: w, storey: g, a: [0, 5], b: [0, 0]}\n"
      "  - {id: p, storey: g, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n"
      "  - {id: attic, storey: up, a: [0, 0], b: [8, 0]}\n"
      "openings: [{id: d, wall: p, s_m: 2}]\n"
      "deviations:\n";
  const bim::PlanWithDeviations read = bim::read_plan_with_deviations(plan + deviations, "p.yaml");
  return {read.as_planned, read.as_built.building, read.as_built.changes};
}

TEST(ReportDeviations, ShowWhereThingsWerePlannedAndWhereTheyStand) {
  const bim::PlannedAndBuilt site = site_of(
      "  - {op: move_wall, wall: p, by: [0.5, 0]}\n"
      "  - {op: remove_opening, opening: d}\n"
      "  - {op: add_clutter, id: tank, storey: g, shape: cylinder, at: [2, 2], size: [1, 1]}\n"
      "  - {op: tilt_wall, wall: attic, deg: 1}\n");
  const std::vector<ReportDeviation> ground = report_deviations(site, 0), upper = report_deviations(site, 1);
  ASSERT_EQ(ground.size(), 3U);
  EXPECT_NEAR(centroid(ground[0].planned_W).x(), 4.0, 1e-12);
  EXPECT_NEAR(centroid(ground[0].built_W).x(), 4.5, 1e-12);
  EXPECT_FALSE(ground[1].planned_W.empty());
  EXPECT_TRUE(ground[1].built_W.empty());
  EXPECT_TRUE(ground[2].planned_W.empty());
  EXPECT_EQ(ground[2].built_W.size(), 32U);  // the corners of round clutter, each once
  EXPECT_GT(signed_area(ground[2].built_W), 0.0);
  ASSERT_EQ(upper.size(), 1U);
  EXPECT_EQ(upper[0].element, "attic");
}

TEST(ReportDeviations, AreNamedOnThePage) {
  const std::vector<ReportDeviation> some =
      report_deviations(site_of("  - {op: move_wall, wall: p, by: [0.5, 0]}\n"), 0);
  EXPECT_NE(list_deviations(some).find("<li>wall p moved: 0.5 m towards +x</li>"), std::string::npos);
  EXPECT_NE(draw_deviations(some).find("class=\"planned\""), std::string::npos);
  EXPECT_NE(draw_deviations(some).find("class=\"asbuilt\""), std::string::npos);
  EXPECT_TRUE(list_deviations({}).empty());
  EXPECT_TRUE(draw_deviations({}).empty());
}

TEST(ReportDeviations, SayWhetherTheRobotCouldSeeThem) {
  // In the left room, whose door to the right one is open: the tank there stands behind the wall, the moved door shows.
  const bim::PlannedAndBuilt site = site_of(
      "  - {op: add_clutter, id: near, storey: g, shape: box, at: [2, 4], size: [0.5, 0.5]}\n"
      "  - {op: add_clutter, id: hidden, storey: g, shape: box, at: [7.4, 4.4], size: [0.5, 0.5]}\n"
      "  - {op: move_opening, opening: d, by_m: 0.4}\n"
      "  - {op: tilt_wall, wall: attic, deg: 1}\n");
  const RunBuilding building(site);
  std::vector<ReportDeviation> ground = report_deviations(site, 0);
  ASSERT_EQ(ground.size(), 3U);
  std::vector<TruthSample> walk;
  for (int i = 0; i < 4; ++i) walk.push_back({1.0 + i, Pose::from_xyz_yaw({1.0, 3.5 + 0.01 * i, 0.3}, 0.0), 0.66});
  set_sights(building, walk, ground);
  EXPECT_EQ(describe({"remove_wall", "w", {}, {}}), "wall w not built");
  EXPECT_EQ(describe({"drop_room", "store", {}, {}}), "room store no longer a room of its own");
  EXPECT_EQ(describe(ground[0]), "clutter near added; in sight from 1 s on");
  EXPECT_EQ(describe(ground[1]), "clutter hidden added; never in sight of the robot");
  EXPECT_EQ(describe(ground[2]), "opening d moved: 0.4 m towards +y; in sight from 1 s on");
}

}  // namespace
}  // namespace plumbline::scenarios
