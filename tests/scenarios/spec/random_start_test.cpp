// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/random_start.h"

#include <gtest/gtest.h>

#include <set>

#include "bim/load/load.h"
#include "tests/data.h"

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
  int bedrooms = 0;
  constexpr int seeds = 30;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Scenario scenario = drawn(building, seed, RandomStart::anywhere);
    const bim::Room* room = room_at(building, *scenario.start.at);
    ASSERT_NE(room, nullptr) << seed;
    if (room->id.ends_with("bedroom")) ++bedrooms;
  }
  // They are half of the area and more than half of what is free; two of five rooms would be 12 of 30 (sigma 2.7).
  EXPECT_GT(bedrooms, 14);
}

TEST(StartSampler, TheSeedAloneDecides) {
  const bim::Building building = house();
  const Scenario a = drawn(building, 5, RandomStart::rooms), b = drawn(building, 5, RandomStart::rooms);
  EXPECT_EQ(write_scenario(a), write_scenario(b));
  EXPECT_NE(*a.start.at, *drawn(building, 6, RandomStart::rooms).start.at);
}

TEST(StartSampler, ABuildingWithOneRoomIsRefused) {
  bim::Building building = house();
  std::erase_if(building.rooms, [](const bim::Room& room) { return room.id != "gallery"; });
  EXPECT_THROW(drawn(building, 1, RandomStart::rooms), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
