// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/obstacles.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/extrude.h"

namespace plumbline::scenarios {
namespace {

TEST(ReportObstacles, AreWhatTheRobotWouldWalkInto) {
  bim::Building building = bim::read_plan_text(
      "plan: 1\n"
      "storeys: [{id: g, height_m: 3}, {id: up, elevation_m: 3.2, height_m: 3}]\n"
      "walls: [{id: s, storey: g, a: [0, 0], b: [8, 0]}]\n"
      "columns: [{id: pillar, storey: g, at: [5, 3], size: [0.4, 0.4]}]\n"
      "clutter:\n"
      "  - {id: desk, storey: g, shape: box, at: [2, 2], size: [1, 2], height_m: 0.8}\n"
      "  - {id: rug, storey: g, shape: box, at: [2, 5], size: [1, 2], height_m: 0.03}\n"
      "  - {id: bed, storey: up, shape: box, at: [2, 2], size: [1, 2], height_m: 0.5}\n",
      "p.yaml");
  bim::Obstacle tent;
  tent.id = "tent";
  tent.kind = "furniture";
  tent.storey = 0;
  tent.body.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tent.body.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  building.obstacles.push_back(tent);
  tent.id = "lamp";
  for (Eigen::Vector3d& p : tent.body.vertices) p.z() += 1.5;
  building.obstacles.push_back(tent);
  tent.id = "leaf";
  tent.kind = "door_leaf";
  for (Eigen::Vector3d& p : tent.body.vertices) p.z() -= 1.5;
  building.obstacles.push_back(tent);

  const std::vector<ReportObstacle> obstacles = obstacles_of(building, bim::make_plan(building));
  ASSERT_EQ(obstacles.size(), 4U);
  const auto expect = [&](std::size_t i, const std::string& id, int storey, bool filled, double area) {
    EXPECT_EQ(obstacles[i].id, id);
    EXPECT_EQ(obstacles[i].storey, storey) << id;
    EXPECT_EQ(obstacles[i].filled, filled) << id;
    EXPECT_NEAR(signed_area(obstacles[i].outline_W), area, 1e-12) << id;
  };
  expect(0, "pillar", 0, true, 0.16);
  expect(1, "desk", 0, true, 2.0);
  expect(2, "bed", 1, true, 2.0);
  expect(3, "tent", 0, false, 0.5);
}

TEST(ReportObstacles, AColumnThatLeansDoesNotFillItsOutline) {
  bim::Building building = bim::read_plan_text(
      "plan: 1\nstoreys: [{id: g, height_m: 3}]\nwalls: [{id: s, storey: g, a: [0, 0], b: [8, 0]}]\n"
      "columns: [{id: pillar, storey: g, at: [5, 3], size: [0.4, 0.4]}]\n",
      "p.yaml");
  bim::Column& pillar = building.columns[0];
  pillar.body = bim::extrude({{pillar.footprint, {}}}, 0.0, 3.0);
  for (Eigen::Vector3d& p : pillar.body->vertices) p.x() += 0.3 * p.z();
  const std::vector<ReportObstacle> obstacles = obstacles_of(building, bim::make_plan(building));
  ASSERT_EQ(obstacles.size(), 1U);
  EXPECT_EQ(obstacles[0].id, "pillar");
  EXPECT_FALSE(obstacles[0].filled);
}

TEST(ReportFlights, HaveARiserForEachStepAndOneAtTheTop) {
  bim::Building building;
  bim::Stair stair;
  stair.from = 0;
  stair.to = 1;
  stair.flights.push_back({{2.0, 1.0}, 0.5 * std::numbers::pi, 1.2, 0.0, 10, 0.17, 0.3});
  building.stairs.push_back(stair);
  const std::vector<ReportFlight> flights = flights_of(building);
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_EQ(flights[0].from, 0);
  EXPECT_EQ(flights[0].to, 1);
  ASSERT_EQ(flights[0].risers_W.size(), 11U);
  const auto& [a, b] = flights[0].risers_W.back();
  EXPECT_LT((0.5 * (a + b) - Eigen::Vector2d(2.0, 4.0)).norm(), 1e-12);
  EXPECT_NEAR((a - b).norm(), 1.2, 1e-12);
  EXPECT_NEAR(a.y(), b.y(), 1e-12) << "across the way up";
}

}  // namespace
}  // namespace plumbline::scenarios
