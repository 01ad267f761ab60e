// SPDX-License-Identifier: Apache-2.0
#include "sim/route/blockage.h"

#include <gtest/gtest.h>

#include "tests/sim/route/floor_plan.h"

namespace plumbline::sim {
namespace {

const Eigen::Vector2d west(2.0, 2.5);
const Eigen::Vector2d east(6.0, 2.5);

std::vector<Blockage> between_rooms(const bim::Building& building) {
  const ClearanceMap space(building, 0);
  return Blockages(building, 0, space, west).before(east);
}

std::string text_of(const std::vector<Blockage>& blockages) {
  std::string text;
  for (const Blockage& blockage : blockages) text += (text.empty() ? "" : "; ") + blockage.text;
  return text;
}

TEST(Blockage, NothingStopsTheRobotBeforeAnOpenDoor) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 0.9);
  EXPECT_EQ(text_of(between_rooms(building)), "");
}

TEST(Blockage, AClosedDoorIsNamed) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 0.9).leaf = bim::Leaf::closed;
  const std::vector<Blockage> found = between_rooms(building);
  EXPECT_EQ(text_of(found), "door 'd0' is closed");
  EXPECT_EQ(found.front().kind, BlockageKind::closed_door);
  EXPECT_NEAR(found.front().at_W.x(), 4.0, 0.2);
}

TEST(Blockage, ANarrowDoorSaysByHowMuch) {
  for (const double width : {0.4, 0.5, 0.6}) {
    bim::Building building = two_rooms();
    add_door(building, 0, 2.5, width);
    const std::vector<Blockage> found = between_rooms(building);
    ASSERT_EQ(found.size(), 1U) << width;
    EXPECT_EQ(found.front().element, "door 'd0'");
    EXPECT_EQ(found.front().text,
              "door 'd0' is " + std::to_string(width).substr(0, 3) + " m wide, and the robot needs 0.7 m");
  }
}

TEST(Blockage, ASillAHeadAndAWindowAreNamed) {
  bim::Building sill = two_rooms();
  add_door(sill, 0, 2.5, 0.9).z0_m = 0.3;
  EXPECT_EQ(text_of(between_rooms(sill)), "door 'd0' begins 0.3 m above the floor, and the robot steps over 0.05 m");
  bim::Building head = two_rooms();
  add_door(head, 0, 2.5, 0.9).z1_m = 1.1;
  EXPECT_EQ(text_of(between_rooms(head)), "door 'd0' ends 1.1 m above the floor, and the robot needs 1.2 m");
  bim::Building window = two_rooms();
  add_door(window, 0, 2.5, 0.9).kind = bim::OpeningKind::window;
  EXPECT_EQ(text_of(between_rooms(window)), "window 'd0' is a window");
}

TEST(Blockage, AWallInADoorAndAWallWithoutADoorAreNamed) {
  bim::Building crossed = two_rooms();
  add_door(crossed, 0, 2.5, 0.9);
  add_wall(crossed, {4.0, 1.0}, {4.0, 4.0});  // overlaps the wall and its door
  EXPECT_EQ(text_of(between_rooms(crossed)), "wall 'w5' stands in door 'd0'");
  const std::vector<Blockage> solid = between_rooms(two_rooms());
  ASSERT_EQ(solid.size(), 1U);
  EXPECT_EQ(solid.front().element, "wall 'w0'");
  EXPECT_EQ(solid.front().text.rfind("wall 'w0' has no door near [", 0), 0U) << solid.front().text;
}

TEST(Blockage, AWallWhoseSurfaceDoesNotCloseIsSolidAllTheSame) {
  bim::Building building = two_rooms();
  bim::Solid open = prism(rectangle({3.9, 0.0}, {4.1, 5.0}), 0.0, 3.0);
  open.triangles.pop_back();
  building.walls.front().body = open;
  EXPECT_EQ(text_of(between_rooms(building)).rfind("wall 'w0' has no door near [", 0), 0U)
      << text_of(between_rooms(building));
}

TEST(Blockage, FurnitureBeforeADoorIsNamed) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 0.9);
  building.obstacles.push_back({"cupboard", "furniture", 0, prism(rectangle({4.2, 1.8}, {4.8, 3.2}), 0.0, 1.5)});
  const std::vector<Blockage> found = between_rooms(building);
  ASSERT_FALSE(found.empty());
  EXPECT_NE(text_of(found).find("furniture 'cupboard'"), std::string::npos) << text_of(found);
  EXPECT_EQ(found.front().kind, BlockageKind::furniture);
}

// The jambs of the door were named, which leave 0.9 m.
TEST(Blockage, AColumnBeforeADoorIsNamed) {
  for (const double half : {0.15, 0.3}) {
    bim::Building building = two_rooms();
    add_door(building, 0, 2.5, 0.9);
    bim::Column column;
    column.id = "c";
    column.storey = 0;
    column.footprint = rectangle({4.15, 2.5 - half}, {4.45, 2.5 + half});
    column.z1_m = 3.0;
    building.columns.push_back(column);
    const std::vector<Blockage> found = between_rooms(building);
    ASSERT_FALSE(found.empty());
    EXPECT_NE(text_of(found).find("column 'c'"), std::string::npos) << text_of(found);
    EXPECT_EQ(text_of(found).find("(wall"), std::string::npos) << text_of(found);
  }
}

/// A ramp up to the door, over the whole width of the room.
TEST(Blockage, ARampThatIsTooSteepSaysSo) {
  for (const double rise : {0.3, 0.6}) {
    bim::Building building = two_rooms();
    add_door(building, 0, 2.5, 0.9);
    bim::Obstacle ramp;
    ramp.id = "r";
    ramp.kind = "ramp";
    ramp.storey = 0;
    ramp.body = prism(rectangle({4.5, 0.1}, {5.7, 4.9}), 0.0, 1.0);
    for (Eigen::Vector3d& p : ramp.body.vertices) p.z() = p.z() > 0.5 ? (p.x() > 5.0 ? rise : 0.0) : -0.2;
    building.obstacles.push_back(ramp);
    bim::Obstacle landing = ramp;
    landing.id = "l";
    landing.kind = "footing";
    landing.body = prism(rectangle({5.7, 0.1}, {7.9, 4.9}), -0.2, rise);
    building.obstacles.push_back(landing);
    EXPECT_EQ(text_of(between_rooms(building)), rise < 0.5 ? "ramp 'r' rises by 25 %, and the robot walks up to 20 %"
                                                           : "ramp 'r' rises by 50 %, and the robot walks up to 20 %");
  }
}

TEST(Blockage, TheEndOfTheFloorIsNamed) {
  bim::Building building = two_rooms();
  add_door(building, 0, 2.5, 0.9);
  building.slabs.front().polygon.outer = rectangle({-0.1, -0.1}, {3.9, 5.1});
  bim::Slab other = building.slabs.front();
  other.polygon.outer = rectangle({5.5, -0.1}, {8.1, 5.1});
  building.slabs.push_back(other);
  EXPECT_EQ(text_of(between_rooms(building)).rfind("there is no floor", 0), 0U) << text_of(between_rooms(building));
}

TEST(Blockage, TheWayThatTakesLeastToClearIsTaken) {
  bim::Building building = two_rooms();
  add_door(building, 0, 1.0, 0.9).leaf = bim::Leaf::closed;
  add_door(building, 0, 4.0, 0.6);
  EXPECT_EQ(between_rooms(building).front().element, "door 'd1'");
}

}  // namespace
}  // namespace plumbline::sim
