// SPDX-License-Identifier: Apache-2.0
// Floors at other heights than the storey's elevation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bim/model/walked_floors.h"
#include "sim/robot/collision.h"
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
    EXPECT_FALSE(space.room_targets(building.rooms[1]).empty()) << "one can stand there all the same";
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

/// Three rooms of 4 x 5 m: one at the storey's elevation, a ramp down, one that much lower.
bim::Building ramp_down(double drop_m, bool as_obstacle) {
  bim::Building building = empty_storey();
  for (const double x : {4.0, 8.0}) add_wall(building, {x, 0}, {x, 5});
  for (const double y : {0.0, 5.0}) add_wall(building, {0, y}, {12, y});
  for (const double x : {0.0, 12.0}) add_wall(building, {x, 0}, {x, 5});
  for (bim::Wall& wall : building.walls) wall.z0_m = -1.0;
  add_door(building, 0, 2.5, 1.2);
  bim::Opening& lower = add_door(building, 1, 2.5, 1.2);
  lower.z0_m = -drop_m;
  lower.z1_m = 2.1 - drop_m;
  for (int i = 0; i < 3; ++i)
    add_room(building, "r" + std::to_string(i), rectangle({4.0 * i + 0.1, 0.1}, {4.0 * i + 3.9, 4.9}));
  building.rooms[2].z0_m = -drop_m;
  bim::Slab slab;
  slab.storey = 0;
  for (const auto& [id, x0, x1, top] : {std::tuple("upper", -0.1, 4.0, 0.0), {"lower", 8.0, 12.1, -drop_m}}) {
    slab.id = id;
    slab.polygon.outer = rectangle({x0, -0.1}, {x1, 5.1});
    slab.z0_m = top - 0.2;
    slab.z1_m = top;
    building.slabs.push_back(slab);
  }
  bim::Solid wedge = prism(rectangle({4.0, 0.0}, {8.0, 5.0}), -0.2, 0.0);
  for (Eigen::Vector3d& p : wedge.vertices) p.z() -= drop_m * (p.x() - 4.0) / 4.0;
  if (as_obstacle) {
    building.obstacles.push_back({});
    building.obstacles.back().id = "ramp";
    building.obstacles.back().kind = "ramp";
    building.obstacles.back().storey = 0;
    building.obstacles.back().body = wedge;
  } else {
    slab.id = "sloping";
    slab.body = wedge;
    slab.polygon.outer = rectangle({4.0, 0.0}, {8.0, 5.0});
    slab.z0_m = -drop_m - 0.2;
    slab.z1_m = 0.0;
    building.slabs.push_back(slab);
  }
  return building;
}

TEST(SunkenFloor, IsWalkedDownARampOfEitherKind) {
  const Eigen::Vector2d far(10.0, 2.5);
  for (const bool as_obstacle : {false, true})
    for (const double drop : {0.3, 0.5}) {
      const bim::Building building = ramp_down(drop, as_obstacle);
      EXPECT_DOUBLE_EQ(bim::walked_floors(building, 0).ground_m, -drop);
      const MultiStoreyPlanner space(building);
      const std::vector<Waypoint> way = space.path({0, west}, {0, far});
      ASSERT_FALSE(way.empty()) << drop << " " << as_obstacle;
      EXPECT_EQ(std::count_if(way.begin(), way.end(), [](const Waypoint& w) { return w.stairs; }), 0);
      EXPECT_NEAR(way.front().p_W.z(), 0.0, 0.01);
      EXPECT_NEAR(way.back().p_W.z(), -drop, 0.01);
      EXPECT_FALSE(space.path({0, far}, {0, west}).empty());
      const Ground ground = building_ground(building, {0});
      for (const double x : {4.5, 5.0, 6.3, 7.7})
        EXPECT_NEAR(ground.height(x, 2.5, 1.0), -drop * (x - 4.0) / 4.0, 1e-6) << x;
      EXPECT_NEAR(ground.height(2.0, 2.5, 1.0), 0.0, 1e-9);
      EXPECT_NEAR(ground.height(10.0, 2.5, 1.0), -drop, 1e-9);
      const std::vector<CollisionBox> boxes = collision_boxes(building, {0});
      EXPECT_TRUE(std::all_of(boxes.begin(), boxes.end(), [](const CollisionBox& box) {
        return distance(box, {6.0, 2.5, 0.1}) > 0.5;
      })) << "nothing stands on the ramp";
    }
}

TEST(SunkenFloor, BehindASlopeThatIsTooSteepOrADropIsOutOfReach) {
  const Eigen::Vector2d far(10.0, 2.5);
  bim::Building steep = ramp_down(0.5, true);
  for (Eigen::Vector3d& p : steep.obstacles[0].body.vertices)
    if (p.x() > 7.0) p.x() = 5.5;  // 0.5 m in 1.5 m
  EXPECT_TRUE(ClearanceMap(steep, 0).path(west, far).empty());
  bim::Building without = ramp_down(0.5, true);
  without.obstacles.clear();
  EXPECT_TRUE(ClearanceMap(without, 0).path(west, far).empty());
}

TEST(SunkenFloor, MayLieUnderSeveralRooms) {
  bim::Building building = two_rooms();  // the middle of their slab lies in the wall between them
  building.slabs.front().z1_m = -0.4;
  for (bim::Room& room : building.rooms) room.z0_m = -0.4;
  EXPECT_EQ(bim::walked_floors(building, 0).ground_m, -0.4);
}

TEST(SunkenFloor, ABareSlabUnderACoveringIsNone) {
  for (const double thickness : {0.02, 0.1, 0.3}) {
    bim::Building building = two_rooms();
    building.slabs.front().z1_m = -thickness;
    EXPECT_EQ(bim::walked_floors(building, 0).ground_m, 0.0) << thickness;
    for (bim::Room& room : building.rooms) room.z0_m = -thickness;
    EXPECT_EQ(bim::walked_floors(building, 0).ground_m, thickness > 0.05 ? -thickness : 0.0) << "the rooms begin there";
  }
}

// The wall reaches far beyond the door, as a curved one does.
TEST(FloorStep, TheThresholdOfADoorIsAsDeepAsItsOpening) {
  bim::Building building = split_level(0.3);
  bim::Wall& wall = building.walls[0];
  bim::Solid body = prism(rectangle({3.9, 0.0}, {4.1, 5.0}), 0.0, 3.0);
  const bim::Solid far = prism(rectangle({2.0, 4.0}, {3.8, 4.2}), 0.0, 3.0);
  for (const Eigen::Vector3i& t : far.triangles)
    body.triangles.emplace_back(t.array() + static_cast<int>(body.vertices.size()));
  body.vertices.insert(body.vertices.end(), far.vertices.begin(), far.vertices.end());
  wall.body = body;
  wall.thickness_m = 2.1;
  building.openings.front().solid = prism(rectangle({3.8, 2.0}, {4.2, 3.0}), 0.3, 2.4);
  const bim::WalkedFloors floors = bim::walked_floors(building, 0);
  EXPECT_EQ(bim::height_at(floors, {4.0, 2.5}), 0.3);
  EXPECT_EQ(bim::height_at(floors, {3.0, 2.5}), 0.0);
}

TEST(FloorStep, NoShortcutLeadsOverAPodiumThatTheWayGoesRound) {
  bim::Building building = empty_storey();
  add_room(building, "hall", rectangle({0, 0}, {10, 8}));
  for (const auto& [id, floor, top] :
       {std::tuple("floor", rectangle({0, 0}, {10, 8}), 0.0), {"podium", rectangle({4, 3}, {6, 5}), 0.15}}) {
    bim::Slab slab;
    slab.id = id;
    slab.storey = 0;
    slab.polygon.outer = floor;
    slab.z0_m = top - 0.15;
    slab.z1_m = top;
    building.slabs.push_back(slab);
  }
  const ClearanceMap space(building, 0);
  ASSERT_NEAR(space.height({5, 4}), 0.15, 1e-6);
  for (const double y : {4.0, 4.4, 4.8})
    for (const PathPart& part : space.parts({1.5, y}, {8.5, y})) {
      if (part.step) continue;
      for (std::size_t i = 1; i < part.points.size(); ++i)
        for (double share = 0.0; share <= 1.0; share += 0.01)
          EXPECT_NEAR(space.height(part.points[i - 1] + share * (part.points[i] - part.points[i - 1])), part.height_m,
                      1e-6)
              << y;
    }
}

}  // namespace
}  // namespace plumbline::sim
