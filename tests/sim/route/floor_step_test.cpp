// SPDX-License-Identifier: Apache-2.0
// Floors at other heights than the storey's elevation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/robot/ground.h"
#include "sim/route/blockage.h"
#include "sim/route/multi_storey_planner.h"
#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

const Eigen::Vector2d west(2.0, 2.5);
const Eigen::Vector2d east(6.0, 2.5);

TEST(FloorStep, AStepThatTheRobotClimbsIsWalkedStraightUpAndDown) {
  for (const double rise : {0.08, 0.15, 0.20}) {
    const bim::Building building = split_level(rise);
    const MultiStoreyPlanner space(building);
    EXPECT_NEAR(space.storey(0).height(east), rise, 1e-6);
    for (const bool up : {true, false}) {
      const std::vector<Waypoint> way = space.path({0, up ? west : east}, {0, up ? east : west});
      ASSERT_GE(way.size(), 3U) << rise;
      EXPECT_EQ(std::count_if(way.begin(), way.end(), [](const Waypoint& w) { return w.stairs; }), 1) << rise;
      EXPECT_NEAR(way.front().p_W.z(), up ? 0.0 : rise, 1e-6);
      EXPECT_NEAR(way.back().p_W.z(), up ? rise : 0.0, 1e-6);
      const auto step = std::find_if(way.begin(), way.end(), [](const Waypoint& w) { return w.stairs; });
      const Eigen::Vector3d over = step->p_W - (step - 1)->p_W;
      EXPECT_NEAR(std::abs(over.z()), rise, 1e-6);
      EXPECT_NEAR(over.y() / over.x(), 0.0, 0.05) << "straight through the door";
    }
  }
}

TEST(FloorStep, AStepThatIsTooHighIsNamedWithItsHeight) {
  for (const double rise : {0.25, 0.45, 0.6}) {
    const bim::Building building = split_level(rise);
    const ClearanceMap space(building, 0);
    EXPECT_TRUE(space.path(west, east).empty());
    EXPECT_FALSE(space.room_target(building.rooms[1].polygon).empty()) << "one can stand there all the same";
    const std::vector<Blockage> found = Blockages(building, 0, space, west).before(east);
    ASSERT_EQ(found.size(), 1U) << rise;
    EXPECT_EQ(found.front().text.rfind("a step of " + std::to_string(rise).substr(0, 3), 0), 0U) << found.front().text;
    EXPECT_NE(found.front().text.find("the 0.2 m that the robot climbs"), std::string::npos) << found.front().text;
  }
}

TEST(FloorStep, AWholeStoreyAboveItsElevationIsWalkable) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 1.0);
  for (const double rise : {0.15, 0.6}) {
    bim::Building raised = building;
    raised.slabs.front().z1_m = rise;
    for (bim::Room& room : raised.rooms) room.z0_m = rise;
    raised.openings.front().z0_m = rise;
    raised.openings.front().z1_m = rise + 2.1;
    const ClearanceMap space(raised, 0);
    EXPECT_FALSE(space.path(west, east).empty()) << rise;
    EXPECT_NEAR(space.height(west), rise, 1e-6);
    EXPECT_NEAR(building_ground(raised, {0}).height(west.x(), west.y(), 2.0), rise, 1e-6);
  }
}

TEST(FloorStep, TheGroundIsAsHighAsTheMapSays) {
  const bim::Building building = split_level(0.15);
  const ClearanceMap space(building, 0);
  const Ground ground = building_ground(building, {0});
  for (double x = 0.5; x < 7.6; x += 0.11)
    for (double y = 0.5; y < 4.6; y += 0.13)
      if (space.free({x, y}) && std::abs(x - 3.9) > 0.06) {
        EXPECT_NEAR(ground.height(x, y, 1.0), space.height({x, y}), 1e-6) << x << " " << y;
      }
}

TEST(FloorStep, NothingChangesWhereFloorsAreLevel) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 1.0);
  const ClearanceMap space(building, 0);
  EXPECT_EQ(space.height(east), 0.0);
  EXPECT_EQ(space.parts(west, east).size(), 1U);
}

}  // namespace
}  // namespace plumbline::sim
