// SPDX-License-Identifier: Apache-2.0
// Default walks through buildings with closed and narrow doors, walls in doorways and missing floors. `bench walks`
// does the same with as many more.
#include "scenarios/app/bench/faulty_building.h"

#include <gtest/gtest.h>

#include <array>

namespace plumbline::scenarios {
namespace {

TEST(FaultyBuilding, DefaultWalksCoverWhatCanBeReachedOrNameWhatStopsThem) {
  std::size_t buildings = 0, refused = 0, missed = 0;
  std::array<std::size_t, 4> faults{};
  for (std::uint64_t k = 0; k < 60; ++k) {
    const std::optional<FaultyBuilding> faulty = faulty_building(k);
    if (!faulty) continue;
    ++buildings;
    for (const Fault& fault : faulty->faults) ++faults[static_cast<std::size_t>(fault.kind)];
    const FaultyWalk walk = walk_through(*faulty);
    EXPECT_EQ(walk.wrong, "") << faulty->what;
    EXPECT_EQ(walk.named, walk.missed) << faulty->what;
    missed += walk.missed;
    refused += walk.refused ? 1U : 0U;
    if (!walk.refused) {
      EXPECT_GE(10 * walk.entered, 9 * walk.reachable) << faulty->what;
    }
  }
  EXPECT_GE(buildings, 55U);
  EXPECT_GE(missed, 40U);
  EXPECT_LE(refused, buildings / 5);
  for (const std::size_t count : faults) EXPECT_GE(count, 5U);
}

// Rooms beside a corridor without a floor: a ledge, or the corner between the edge and a doorway.
TEST(FaultyBuilding, TheEdgeOfTheFloorIsNamedWhereItLeavesTooLittleRoom) {
  for (const std::uint64_t k : {236U, 376U, 446U, 651U, 936U, 1296U, 1566U}) {
    const std::optional<FaultyBuilding> faulty = faulty_building(k);
    ASSERT_TRUE(faulty.has_value()) << k;
    const FaultyWalk walk = walk_through(*faulty);
    EXPECT_EQ(walk.wrong, "") << faulty->what;
    EXPECT_EQ(walk.named, walk.missed) << faulty->what;
  }
}

TEST(FaultyBuilding, WhatHasNoFloorAnywhereIsRefusedForThat) {
  const std::optional<FaultyBuilding> faulty = faulty_building(1418);
  ASSERT_TRUE(faulty.has_value());
  EXPECT_EQ(faulty->faults.size(), 2U);
  const FaultyWalk walk = walk_through(*faulty);
  EXPECT_TRUE(walk.refused);
  EXPECT_EQ(walk.wrong, "") << faulty->what;
}

TEST(FaultyBuilding, ReachabilityIsThatOfTheDoors) {
  FaultyBuilding faulty;
  faulty.building.rooms.resize(3);
  faulty.building.openings.resize(2);
  for (int i = 0; i < 3; ++i) faulty.building.rooms[static_cast<std::size_t>(i)].id = "r" + std::to_string(i);
  for (int i = 0; i < 2; ++i) {
    bim::Opening& door = faulty.building.openings[static_cast<std::size_t>(i)];
    door.id = "d" + std::to_string(i);
    door.rooms[0] = i;
    door.rooms[1] = i + 1;
  }
  EXPECT_EQ(faulty.reachable("r0").size(), 3U);
  faulty.faults = {{FaultKind::narrow_door, "door 'd1'", "d1"}, {FaultKind::missing_floor, "", "r1"}};
  EXPECT_EQ(faulty.reachable("r0").size(), 1U);
  EXPECT_EQ(faulty.reachable("r0", {1}).size(), 2U);
  EXPECT_EQ(faulty.reachable("r0", {0, 1}).size(), 3U);
}

}  // namespace
}  // namespace plumbline::scenarios
