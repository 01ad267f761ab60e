// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/random_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "bim/load/load.h"
#include "scenarios/spec/start_check.h"
#include "tests/data.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::scenarios {
namespace {

bim::Building house() { return bim::load_building(project_file("scenarios/library/house.plan.yaml")); }

Scenario drawn(const bim::Building& building, std::uint64_t seed, RandomStart how) {
  Scenario scenario;
  scenario.seed = seed;
  scenario.start.random = how;
  scenario.start.storey = "upper";
  scenario.route.rooms = {"all"};
  scenario.route.random = 4;
  sample_start(building, scenario, {});
  return scenario;
}

const bim::Room* room_at(const bim::Building& building, const Eigen::Vector2d& p) {
  for (const bim::Room& room : building.rooms)
    if (building.storeys[static_cast<std::size_t>(room.storey)].id == "upper" && contains(room.polygon, p))
      return &room;
  return nullptr;
}

TEST(StartSampler, EveryRoomOfTheStoreyAndEveryQuadrantComesUp) {
  const bim::Building building = house();
  std::set<std::string> starts, goals;
  std::set<int> quadrants;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Scenario scenario = drawn(building, seed, RandomStart::rooms);
    const bim::Room* room = room_at(building, *scenario.start.at);
    ASSERT_NE(room, nullptr) << seed;
    starts.insert(room->id);
    quadrants.insert(static_cast<int>(std::floor(*scenario.start.yaw_deg / 90.0)));
    ASSERT_EQ(scenario.route.rooms.size(), 4U);
    std::string before = room->id;
    for (const std::string& id : scenario.route.rooms) {
      EXPECT_NE(id, before) << seed;
      goals.insert(before = id);
    }
    EXPECT_GT(plan_route(building, scenario.start, scenario.route, {}).length_m, 1.0);
  }
  // Chance that one of five rooms never comes up in 30 draws: 5 * 0.8^30 = 0.6 %.
  EXPECT_EQ(starts.size(), 5U);
  EXPECT_EQ(goals.size(), 5U);
  EXPECT_EQ(quadrants, (std::set<int>{-2, -1, 0, 1}));
}

TEST(StartSampler, AnywhereFollowsTheFloorSpace) {
  const bim::Building building = house();
  int bedrooms = 0, open_floor = 0, passages = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scenario scenario = drawn(building, seed, RandomStart::anywhere);
    if (!scenario.start.yaw_deg) {  // a doorway or the head of the stair
      ++passages;
      continue;
    }
    const bim::Room* room = room_at(building, *scenario.start.at);
    ASSERT_NE(room, nullptr) << seed;
    ++open_floor;
    if (room->id.ends_with("bedroom")) ++bedrooms;
  }
  // Every fourth draw is a passage, sigma 3.4 of 60. Bedrooms are half of the area and more than half of what is free;
  // two of five rooms would be 40 % of the draws.
  EXPECT_GT(passages, 4);
  EXPECT_LT(passages, 28);
  EXPECT_GT(10 * bedrooms, 4 * open_floor);
}

TEST(StartSampler, AnywhereDrawsDoorwaysAndStairHeadsFromWhichTheWalkIsPlanned) {
  const bim::Building building = house();
  int doorways = 0, heads = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scenario scenario = drawn(building, seed, RandomStart::anywhere);
    const RoutePlan plan = plan_route(building, scenario.start, scenario.route, {});
    EXPECT_EQ(plan.start_W, *scenario.start.at) << seed;
    EXPECT_GT(plan.length_m, 0.5) << seed;
    if (scenario.start.yaw_deg) continue;
    if (in_a_doorway(building, plan.storey, plan.start_W))
      ++doorways;
    else
      ++heads;
    const Eigen::Vector3d leg = plan.waypoints[1].p_W - plan.waypoints[0].p_W;
    EXPECT_NEAR(wrap_angle(plan.yaw_deg * std::numbers::pi / 180.0 - std::atan2(leg.y(), leg.x())), 0.0, 1e-3) << seed;
  }
  EXPECT_GT(doorways, 0);
  EXPECT_GT(heads, 0);
}

TEST(StartSampler, RoomsAreDrawnAsBeforeThereWereOtherPlaces) {
  const Scenario scenario = drawn(house(), 5, RandomStart::rooms);
  EXPECT_TRUE(scenario.start.yaw_deg.has_value());
  EXPECT_FALSE(in_a_doorway(house(), 1, *scenario.start.at));
}

TEST(StartSampler, TheSeedAloneDecides) {
  const bim::Building building = house();
  const Scenario a = drawn(building, 5, RandomStart::rooms), b = drawn(building, 5, RandomStart::rooms);
  EXPECT_EQ(write_scenario(a), write_scenario(b));
  EXPECT_NE(*a.start.at, *drawn(building, 6, RandomStart::rooms).start.at);
}

/// One room of the house and nothing else to go to.
bim::Building gallery() {
  bim::Building building = house();
  std::erase_if(building.rooms, [](const bim::Room& room) { return room.id != "gallery"; });
  return building;
}

TEST(StartSampler, OneRoomAloneHasStartsButNoRoomsToDrawARouteFrom) {
  const bim::Building building = gallery();
  std::set<std::pair<double, double>> places;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const RandomStart how : {RandomStart::rooms, RandomStart::anywhere}) {
      Scenario scenario;
      scenario.seed = seed;
      scenario.start.random = how;
      scenario.start.storey = "upper";
      scenario.route.rooms = {"all"};
      sample_start(building, scenario, {});
      ASSERT_TRUE(contains(building.rooms.front().polygon, *scenario.start.at)) << seed;
      places.insert({scenario.start.at->x(), scenario.start.at->y()});
    }
  EXPECT_EQ(places.size(), 5U);  // one a seed: in one room both draw alike
  try {
    drawn(building, 1, RandomStart::rooms);
    FAIL() << "a route was drawn";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("route: {rooms: all}"), std::string::npos) << error.what();
  }
}

/// Two houses wall to wall, each of two rooms with a door between them.
bim::Building two_houses() {
  bim::Building building = sim::empty_storey();
  const auto rooms = {"a0", "a1", "b0", "b1"};
  double x = 0.0;
  for (const char* room : rooms) {
    sim::add_wall(building, {x, 0.0}, {x, 5.0});
    sim::add_room(building, room, sim::rectangle({x + 0.1, 0.1}, {x + 3.9, 4.9}));
    x += 4.0;
  }
  sim::add_wall(building, {x, 0.0}, {x, 5.0});
  sim::add_wall(building, {0, 0}, {x, 0});
  sim::add_wall(building, {x, 5}, {0, 5});
  sim::add_door(building, 1, 2.5, 0.9);
  sim::add_door(building, 3, 2.5, 0.9);
  bim::Slab slab;
  slab.id = "slab";
  slab.storey = 0;
  slab.polygon.outer = sim::rectangle({-0.1, -0.1}, {x + 0.1, 5.1});
  building.slabs.push_back(slab);
  return building;
}

TEST(StartSampler, TheRoomsThatARouteNamesCanBeReachedFromADrawnStart) {
  const bim::Building building = two_houses();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scenario scenario;
    scenario.seed = seed;
    scenario.start.random = RandomStart::rooms;
    scenario.route.rooms = {"b1", "b0"};
    sample_start(building, scenario, {});
    EXPECT_GT(scenario.start.at->x(), 8.0) << seed;
    EXPECT_GT(plan_route(building, scenario.start, scenario.route, {}).length_m, 0.5) << seed;
  }
}

TEST(StartSampler, ARouteThroughBothHousesIsLeftToThePlannerToRefuse) {
  const bim::Building building = two_houses();
  Scenario scenario;
  scenario.start.random = RandomStart::rooms;
  scenario.route.rooms = {"a0", "b0"};
  sample_start(building, scenario, {});
  EXPECT_TRUE(scenario.start.at.has_value());
  EXPECT_THROW(static_cast<void>(plan_route(building, scenario.start, scenario.route, {})), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
