// SPDX-License-Identifier: Apache-2.0
#include "sim/route/narrow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

TEST(Narrow, ADoorOnALongLegGetsWaypointsOfItsOwn) {
  bim::Building building = two_rooms(1.5);
  add_door(building, 0, 2.5, 0.9);
  const ClearanceMap space(building, 0);
  const std::vector<Waypoint> way = with_clearance(space, {{1.5, 2.5}, {6.5, 2.5}}, 1.5);
  ASSERT_EQ(way.size(), 4U);
  EXPECT_NEAR(way[2].clearance_m, 0.45, 0.03);
  EXPECT_GT(way[1].clearance_m, 1e9);
  EXPECT_GT(way[3].clearance_m, 1e9);
  // The wall is 0.2 m thick; less than 0.6 m from the corners of its door is narrow, and 0.2 m before.
  EXPECT_NEAR(way[1].p_W.x(), 3.9 - std::sqrt(0.36 - 0.45 * 0.45) - 0.2, 0.06);
  EXPECT_NEAR(way[2].p_W.x(), 4.1 + std::sqrt(0.36 - 0.45 * 0.45) + 0.2, 0.06);
  for (const Waypoint& w : way) EXPECT_EQ(w.p_W.z(), 1.5);
}

TEST(Narrow, AnOpenWayStaysAsItIs) {
  const ClearanceMap space(two_rooms(), 0);
  const std::vector<Waypoint> way = with_clearance(space, {{1.5, 1.5}, {2.5, 1.5}, {2.5, 3.5}}, 0.0);
  EXPECT_EQ(way.size(), 3U);
  EXPECT_TRUE(with_clearance(space, {}, 0.0).empty());
  EXPECT_EQ(with_clearance(space, {{1.5, 1.5}}, 0.0).size(), 1U);
}

TEST(Narrow, ALegThatIsNarrowAllAlongStaysOne) {
  bim::Building building = two_rooms();
  add_obstacle(building, rectangle({1.0, 3.0}, {3.0, 4.0}), 0.0, 1.0);
  add_obstacle(building, rectangle({1.0, 1.2}, {3.0, 2.2}), 0.0, 1.0);
  const std::vector<Waypoint> way = with_clearance(ClearanceMap(building, 0), {{1.2, 2.6}, {2.8, 2.6}}, 0.0);
  ASSERT_EQ(way.size(), 2U);
  EXPECT_NEAR(way[1].clearance_m, 0.4, 0.03);
}

}  // namespace
}  // namespace plumbline::sim
