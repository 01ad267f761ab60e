// SPDX-License-Identifier: Apache-2.0
#include "sim/route/multi_storey_planner.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/extrude.h"
#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

/// Two storeys of 8 x 6 m, 3 m apart, with the floor above cut over the stair.
std::string tower(const std::string& stair, const std::string& more = "") {
  std::string text = "plan: 1\nname: tower\nstoreys:\n";
  text += "  - {id: ground, elevation_m: 0, height_m: 2.7}\n  - {id: upper, elevation_m: 3, height_m: 2.7}\n";
  text += "walls:\n";
  for (const std::string storey : {"ground", "upper"}) {
    const auto wall = [&](const std::string& name, const std::string& a, const std::string& b) {
      text += "  - {id: " + storey + "_" + name + ", storey: " + storey + ", a: " + a + ", b: " + b +
              ", thickness_m: 0.2, just: right}\n";
    };
    wall("south", "[0, 0]", "[8, 0]");
    wall("east", "[8, 0]", "[8, 6]");
    wall("north", "[8, 6]", "[0, 6]");
    wall("west", "[0, 6]", "[0, 0]");
  }
  text += "rooms:\n  - {id: below, storey: ground, polygon: [[0, 0], [8, 0], [8, 6], [0, 6]]}\n";
  text += "  - {id: above, storey: upper, polygon: [[0, 0], [8, 0], [8, 6], [0, 6]]}\n";
  return text + "stairs:\n  - " + stair + "\n" + more;
}

const std::string straight =
    "{id: stair, from: ground, to: upper, start: [1.6, 3], width_m: 1.0, rise_m: 0.18, run_m: 0.27}";
const std::string back =
    "{id: stair, from: ground, to: upper, start: [3, 2.4], width_m: 1.0, rise_m: 0.18, run_m: 0.27, landing_after: 8, "
    "landing_m: 1.0, turn: back_left, gap_m: 0.2}";
const std::string left =
    "{id: stair, from: ground, to: upper, start: [2, 1], width_m: 1.0, rise_m: 0.18, run_m: 0.27, landing_after: 8, "
    "landing_m: 1.0, turn: left}";

bim::Building building(const std::string& stair, const std::string& more = "") {
  return bim::read_plan_text(tower(stair, more), "tower.plan.yaml");
}

std::vector<Eigen::Vector3d> over_stairs(const std::vector<Waypoint>& path) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].stairs || (i + 1 < path.size() && path[i + 1].stairs)) points.push_back(path[i].p_W);
  return points;
}

TEST(MultiStoreyPlanner, GoesUpTheMiddleOfAStraightStair) {
  const bim::Building tower = building(straight);
  const MultiStoreyPlanner space(tower);
  const std::vector<Eigen::Vector3d> points = over_stairs(space.path({0, {1.0, 5.0}}, {1, {7.0, 5.0}}));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_LT((points[0] - Eigen::Vector3d(0.9, 3.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((points[1] - Eigen::Vector3d(1.6 + 17 * 0.27 + 0.7, 3.0, 3.0)).norm(), 1e-9);
}

TEST(MultiStoreyPlanner, TurnsOnALandingWithRoomBehindTheKnees) {
  const bim::Building tower = building(back);
  const MultiStoreyPlanner space(tower);
  const std::vector<Eigen::Vector3d> points = over_stairs(space.path({0, {1.0, 5.0}}, {1, {1.0, 5.0}}));
  ASSERT_EQ(points.size(), 4U);
  const double middle = 3.0 + 8 * 0.27 + 0.5, level = 8 * 3.0 / 17;
  EXPECT_LT((points[1] - Eigen::Vector3d(middle, 2.4, level)).norm(), 1e-9);
  EXPECT_LT((points[2] - Eigen::Vector3d(middle - 0.1, 3.6, level)).norm(), 1e-9);
  EXPECT_LT(points[3].x(), 3.0 + 8 * 0.27 - 9 * 0.27 - 0.4);
  EXPECT_EQ(points[3].y(), 3.6);
}

TEST(MultiStoreyPlanner, TurnsOnceOnAQuarterLanding) {
  const bim::Building tower = building(left);
  const std::vector<Eigen::Vector3d> points =
      over_stairs(MultiStoreyPlanner(tower).path({0, {1.0, 5.0}}, {1, {1.0, 5.0}}));
  ASSERT_EQ(points.size(), 3U);
  EXPECT_LT((points[1].head<2>() - Eigen::Vector2d(2.0 + 8 * 0.27 + 0.5, 1.0)).norm(), 1e-9);
  EXPECT_NEAR(points[2].x(), points[1].x(), 1e-9);
}

TEST(MultiStoreyPlanner, TheWayDownIsTheWayUpBackwards) {
  for (const std::string& stair : {straight, back, left}) {
    const bim::Building tower = building(stair);
    const MultiStoreyPlanner space(tower);
    std::vector<Eigen::Vector3d> up = over_stairs(space.path({0, {1.0, 5.0}}, {1, {7.0, 5.0}}));
    const std::vector<Eigen::Vector3d> down = over_stairs(space.path({1, {7.0, 5.0}}, {0, {1.0, 5.0}}));
    std::reverse(up.begin(), up.end());
    EXPECT_EQ(up, down);
    EXPECT_GE(up.size(), 2U);
  }
}

TEST(MultiStoreyPlanner, HeightsGrowFromFloorToFloor) {
  const bim::Building tower = building(back);
  const std::vector<Waypoint> path = MultiStoreyPlanner(tower).path({0, {1.0, 5.0}}, {1, {7.0, 5.0}});
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(path.front().p_W.z(), 0.0);
  EXPECT_EQ(path.back().p_W.z(), 3.0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_GE(path[i].p_W.z(), path[i - 1].p_W.z());
    EXPECT_TRUE(path[i].stairs || path[i].p_W.z() == path[i - 1].p_W.z());
  }
}

TEST(MultiStoreyPlanner, AWayOnOneStoreyTakesNoStair) {
  const bim::Building tower = building(straight);
  const MultiStoreyPlanner space(tower);
  const std::vector<Waypoint> path = space.path({0, {1.0, 5.0}}, {0, {7.0, 1.0}});
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(length_on_stairs(path), 0.0);
  EXPECT_EQ(space.reachable_storeys({0, {1.0, 5.0}}), (std::vector<int>{0, 1}));
}

TEST(MultiStoreyPlanner, StairsThatCannotBeWalkedSayWhy) {
  const auto fault = [](const std::string& stair, const std::string& more = "") {
    const bim::Building tower = building(stair, more);
    const MultiStoreyPlanner space(tower);
    EXPECT_TRUE(space.path({0, {1.0, 5.0}}, {1, {7.0, 5.0}}).empty()) << stair;
    EXPECT_EQ(space.reachable_storeys({0, {1.0, 5.0}}), std::vector<int>{0});
    return space.stairs().front().fault;
  };
  const std::string common = "{id: stair, from: ground, to: upper, start: [1.6, 3], ";
  EXPECT_EQ(fault(common + "width_m: 0.6, rise_m: 0.18, run_m: 0.27}"), "is 0.6 m wide; the robot needs 0.7 m");
  EXPECT_NE(fault(common + "width_m: 1.0, rise_m: 0.25, run_m: 0.27}").find("has steps of 0.25 m"), std::string::npos);
  EXPECT_NE(fault(common + "width_m: 1.0, rise_m: 0.18, run_m: 0.22}").find("0.22 m deep"), std::string::npos);
  const std::string box = "clutter:\n  - {id: box, storey: ground, shape: box, at: ";
  EXPECT_EQ(fault(straight, box + "[0.65, 3.0], size: [0.6, 0.6], height_m: 1}\n"),
            "has no room before its first step");
  EXPECT_NE(fault(straight, box + "[3.0, 2.3], size: [0.8, 0.8], height_m: 2}\n").find("free near"), std::string::npos);
}

/// A stair drawn at random that keeps clear of the facade, or nothing when the plan refuses it.
std::optional<bim::Building> random_tower(const Stream& stream, std::uint64_t i) {
  constexpr std::array<const char*, 5> turns = {"none", "left", "right", "back_left", "back_right"};
  const auto between = [&](std::uint32_t draw, double low, double high) {
    return format_number(std::round(1e3 * (low + (high - low) * stream.uniform(i, draw))) / 1e3);
  };
  const auto turn = static_cast<std::size_t>(5.0 * stream.uniform(i, 9));
  std::string stair = "{id: stair, from: ground, to: upper, start: [" + between(0, 1.0, 7.0) + ", " +
                      between(1, 1.0, 5.0) + "], yaw_deg: " + between(2, -180.0, 180.0) +
                      ", width_m: " + between(3, 0.6, 1.4) + ", rise_m: " + between(4, 0.15, 0.2) +
                      ", run_m: " + between(5, 0.24, 0.3);
  if (stream.uniform(i, 8) < 0.8)
    stair += ", landing_after: " + std::to_string(4 + static_cast<int>(8.0 * stream.uniform(i, 6))) +
             ", landing_m: " + between(7, 1.0, 1.5) + ", turn: " + turns[turn];
  try {
    return building(stair + "}");
  } catch (const InputError&) {
    return std::nullopt;
  }
}

TEST(MultiStoreyPlanner, RandomStairsAreClimbedInTheMiddleOrRefused) {
  const Stream stream(7, "bim.generate");
  int walked = 0, refused = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const std::optional<bim::Building> tower = random_tower(stream, i);
    if (!tower) continue;
    const bim::Stair& stair = tower->stairs.front();
    const MultiStoreyPlanner space(*tower);
    const StairWay& way = space.stairs().front();
    if (!way.fault.empty()) {
      ++refused;
      continue;
    }
    ++walked;
    // Over every flight from its first to its last step along its middle.
    for (const bim::StairFlight& flight : stair.flights) {
      const Eigen::Vector2d e(std::cos(flight.yaw), std::sin(flight.yaw));
      for (const double s : {0.0, 0.5, 1.0}) {
        const Eigen::Vector2d p = flight.start + s * flight.steps * flight.run_m * e;
        double off = 1e9;
        for (std::size_t k = 1; k < way.points.size(); ++k)
          off = std::min(off, segment_distance(way.points[k - 1].head<2>(), way.points[k].head<2>(), p));
        EXPECT_LT(off, 1e-6) << i;
      }
    }
    // Each turn has the robot's radius to the landing's edges, but for the flight that it faces then.
    for (std::size_t k = 1; k + 1 < way.points.size(); ++k) {
      EXPECT_TRUE(contains(stair.landings.front().polygon, Eigen::Vector2d(way.points[k].head<2>()))) << i;
      EXPECT_GE(boundary_distance(stair.landings.front().polygon, way.points[k].head<2>()), 0.3 - 1e-9) << i;
    }
    EXPECT_TRUE(space.storey(0).free(way.points.front().head<2>()));
    EXPECT_TRUE(space.storey(1).free(way.points.back().head<2>()));
  }
  EXPECT_GE(walked, 20);
  EXPECT_GE(refused, 5);
}

TEST(MultiStoreyPlanner, WhatEndsUnderTheFloorAboveIsNotInTheWayOfTheLastSteps) {
  bim::Building tower = building(straight);
  bim::Wall under = tower.walls.front();
  under.id = "under";
  under.a = {6.5, 2.0};
  under.b = {6.5, 4.0};
  under.z1_m = 2.95;
  tower.walls.push_back(under);
  EXPECT_EQ(MultiStoreyPlanner(tower).stairs().front().fault, "");
  tower.walls.back().z1_m = 3.6;
  EXPECT_NE(MultiStoreyPlanner(tower).stairs().front().fault, "");
}

/// The floor above begins beyond the last step, by as much as the robot does not step over.
TEST(MultiStoreyPlanner, AGapInTheFloorBeyondTheLastStepIsAFault) {
  const double head = 1.6 + 17 * 0.27;
  const auto fault = [&](double gap_m) {
    bim::Building tower = building(straight);
    bim::Slab slab;
    slab.id = "upper floor";
    slab.storey = 1;
    slab.z0_m = 2.8;
    slab.z1_m = 3.0;
    slab.polygon = {{{0, 0}, {8, 0}, {8, 6}, {0, 6}},
                    {{{1.5, 2.4}, {1.5, 3.6}, {head + gap_m, 3.6}, {head + gap_m, 2.4}}}};
    std::erase_if(tower.slabs, [](const bim::Slab& other) { return other.z1_m > 2.9 && other.z1_m < 3.1; });
    tower.slabs.push_back(slab);
    return MultiStoreyPlanner(tower).stairs().front().fault;
  };
  EXPECT_EQ(fault(0.0), "");
  EXPECT_EQ(fault(0.08), "");
  EXPECT_NE(fault(0.3).find("in the floor beyond its last step"), std::string::npos) << fault(0.3);
}

TEST(MultiStoreyPlanner, AStairIsUnderTheStairAbove) {
  bim::Building tower = building(straight);
  tower.storeys.push_back(tower.storeys.back());
  tower.storeys.back().id = "top";
  tower.storeys.back().elevation_m = 6.0;
  bim::Stair above = tower.stairs.front();
  above.id = "above";
  above.from = 1;
  above.to = 2;
  for (bim::StairFlight& flight : above.flights) flight.z0_m += 3.0;
  for (bim::Solid& body : above.bodies)
    for (Eigen::Vector3d& p : body.vertices) p.z() += 3.0;
  tower.stairs.push_back(above);
  EXPECT_EQ(MultiStoreyPlanner(tower).stairs().front().fault, "") << "a flight as thick as a slab leaves headroom";
  const Polygon2 shaft{{1.6, 2.5}, {5.9, 2.5}, {5.9, 3.5}, {1.6, 3.5}};
  tower.stairs.back().bodies.push_back(bim::extrude({{shaft, {}}}, 3.0, 4.0));
  EXPECT_NE(MultiStoreyPlanner(tower).stairs().front().fault.find("free near"), std::string::npos);
}

TEST(MultiStoreyPlanner, AStairWithoutStepsIsABody) {
  bim::Building tower = building(straight);
  tower.stairs.front().flights.clear();
  const MultiStoreyPlanner space(tower);
  EXPECT_TRUE(space.path({0, {1.0, 5.0}}, {1, {7.0, 5.0}}).empty());
  EXPECT_EQ(space.stairs().front().fault, "is a body without recognizable steps");
}

TEST(MultiStoreyPlanner, OnlyALandingThatTurnsMustBeDeep) {
  const std::string landing = straight.substr(0, straight.size() - 1) + ", landing_after: 8, landing_m: 0.5}";
  const bim::Building on = building(landing);
  EXPECT_EQ(over_stairs(MultiStoreyPlanner(on).path({0, {1.0, 5.0}}, {1, {7.4, 5.0}})).size(), 2U);
  bim::Building tower = building(left);
  Polygon2& polygon = tower.stairs.front().landings.front().polygon;
  for (Eigen::Vector2d& p : polygon) p.x() = std::min(p.x(), 2.0 + 8 * 0.27 + 0.6);
  EXPECT_EQ(MultiStoreyPlanner(tower).stairs().front().fault, "has a landing 0.6 m deep; the robot needs 0.7 m");
}

TEST(MultiStoreyPlanner, FlightsWithoutALandingBetweenThemMustRunStraightOn) {
  bim::Building tower = building(back);
  tower.stairs.front().landings.clear();
  EXPECT_NE(MultiStoreyPlanner(tower).stairs().front().fault.find("winds"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::sim
