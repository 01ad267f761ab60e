// SPDX-License-Identifier: Apache-2.0
#include "sim/route/neighbour_ways.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"
#include "sim/route/waypoint.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

double walked(const ClearanceMap& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return length(on_floor(space.path(a, b), 0.0));
}

TEST(NeighbourWays, LengthsAreThoseOfTheWalkToATenth) {
  bim::Building building = two_rooms();
  add_door(building, 0, 1.2, 1.0);
  const ClearanceMap space(building, 0);
  const Stream stream(5, "sim.lidar.range");
  for (std::uint64_t i = 0; i < 30; ++i) {
    const auto draw = [&](std::uint32_t lane) {
      return Eigen::Vector2d(0.6 + 2.8 * stream.uniform(i, lane), 0.6 + 3.8 * stream.uniform(i, lane + 1));
    };
    const Eigen::Vector2d a = draw(0), b = draw(2) + Eigen::Vector2d(4.0, 0.0);
    const std::vector<NeighbourWay> ways = neighbour_ways(space, {a, b});
    ASSERT_EQ(ways.size(), 1U);
    const double straight = walked(space, a, b);
    EXPECT_GE(ways.front().length_m, straight - 0.1) << i;
    // Steps of the grid turn by 45 degrees (8 %), and the walk cuts corners.
    EXPECT_LE(ways.front().length_m, 1.2 * straight + 0.1) << i;
  }
}

TEST(NeighbourWays, OnlyNeighboursHaveOne) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 1.0);
  const ClearanceMap space(building, 0);
  const std::vector<NeighbourWay> ways = neighbour_ways(space, {{1.0, 2.5}, {3.0, 2.5}, {6.0, 2.5}, {4.0, 4.0}});
  ASSERT_EQ(ways.size(), 2U);  // the last place is in the wall
  EXPECT_EQ(ways[0].a, 0U);
  EXPECT_EQ(ways[0].b, 1U);
  EXPECT_EQ(ways[1].a, 1U);
  EXPECT_EQ(ways[1].b, 2U);
}

TEST(NeighbourWays, RoomsWithoutADoorHaveNone) {
  EXPECT_TRUE(neighbour_ways(ClearanceMap(two_rooms(), 0), {{2.0, 2.5}, {6.0, 2.5}}).empty());
}

}  // namespace
}  // namespace plumbline::sim
