// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/storey_kinds.h"

#include <gtest/gtest.h>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/read/material_names.h"
#include "bim/formats/ifc/step/step_class.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

Wall wall_on(int storey, double z0_m, double z1_m) {
  Wall wall;
  wall.storey = storey;
  wall.b = {4, 0};
  wall.z0_m = z0_m;
  wall.z1_m = z1_m;
  return wall;
}

Room room_on(int storey) {
  Room room;
  room.storey = storey;
  return room;
}

TEST(StoreyKinds, FoundationAndRoofHoldNoRoomsBetweenWalls) {
  Building building;
  building.storeys = {{"fdn", "", -1.2, 1.2}, {"g", "", 0.0, 3.0}, {"roof", "", 3.0, 1.0}};
  building.walls = {wall_on(0, -1.2, 0.0), wall_on(1, 0.0, 3.0), wall_on(2, 3.0, 3.4)};
  building.rooms = {room_on(1), room_on(2)};
  set_storey_kinds(building);
  EXPECT_EQ(building.storeys[0].kind, StoreyKind::foundation);
  EXPECT_EQ(building.storeys[1].kind, StoreyKind::habitable);
  EXPECT_EQ(building.storeys[2].kind, StoreyKind::roof);
}

TEST(StoreyKinds, TallFoundationWallsDoNotMakeABasement) {
  Building building;
  building.storeys = {{"fdn", "", -3.0, 3.0}, {"g", "", 0.0, 3.0}};
  building.walls = {wall_on(0, -3.0, 0.0), wall_on(1, 0.0, 3.0)};
  building.rooms = {room_on(1)};
  set_storey_kinds(building);
  EXPECT_EQ(building.storeys[0].kind, StoreyKind::foundation);
  building.rooms.push_back(room_on(0));
  set_storey_kinds(building);
  EXPECT_EQ(building.storeys[0].kind, StoreyKind::habitable);
}

TEST(StoreyKinds, WithoutRoomsAndFloorsWallsDecide) {
  Building building;
  building.storeys = {{"g", "", 0.0, 3.0}};
  building.walls = {wall_on(0, 0.0, 3.0)};
  set_storey_kinds(building);
  EXPECT_EQ(building.storeys[0].kind, StoreyKind::habitable);
  EXPECT_TRUE(building.warnings.empty());
}

class StoreyKindsOf : public testing::TestWithParam<const char*> {};

TEST_P(StoreyKindsOf, TwoStoreysCanBeWalkedOn) {
  const std::string name = std::string("ifc/") + GetParam() + ".ifc";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = read_ifc(data_path(name));
  ASSERT_EQ(building.storeys.size(), 4u);
  EXPECT_EQ(building.storeys[0].kind, StoreyKind::foundation);
  EXPECT_EQ(building.storeys[1].kind, StoreyKind::habitable);
  EXPECT_EQ(building.storeys[2].kind, StoreyKind::habitable);
  EXPECT_EQ(building.storeys[3].kind, StoreyKind::roof);
}

INSTANTIATE_TEST_SUITE_P(Own, StoreyKindsOf, testing::Values("twin_flats"),
                         [](const auto& info) { return std::string(info.param); });
INSTANTIATE_TEST_SUITE_P(Foreign, StoreyKindsOf, testing::Values("duplex"),
                         [](const auto& info) { return std::string(info.param); });

TEST(MaterialNames, GlassIsWhatOneSeesThrough) {
  for (const char* name : {"Glass", "Glas - klar", "Glazing, double", "Vidrio", "Verre trempe", "Isolierverglasung"})
    EXPECT_TRUE(says_glass(name)) << name;
  for (const char* name : {"Brick", "Glass wool", "Fiberglass batt", "Glasfaser", "Glass block", "", "Mineralwolle"})
    EXPECT_FALSE(says_glass(name)) << name;
  EXPECT_GT(material_named("Glass").transmission, 0.5);
  EXPECT_EQ(material_named("Brick").reflectivity, Material{}.reflectivity);
}

TEST(StepClass, ObstaclesAreNamedAfterTheirClass) {
  EXPECT_EQ(obstacle_kind("IfcBeam"), "beam");
  EXPECT_EQ(obstacle_kind("IfcFlowTerminal"), "flow_terminal");
  EXPECT_EQ(obstacle_kind("IfcFurnishingElement"), "furniture");
  EXPECT_EQ(obstacle_kind("IfcBuildingElementProxy"), "proxy");
}

}  // namespace
}  // namespace plumbline::bim
