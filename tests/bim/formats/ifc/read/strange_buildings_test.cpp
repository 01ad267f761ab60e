// SPDX-License-Identifier: Apache-2.0
// Buildings that are not as most are: curved walls, rooms within rooms, ceilings, sizes, several in a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

/// A ring of facets as two half-circle walls, the first with a door in the middle; no spaces.
Sketch rotunda() {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, -0.2, 0);
  for (const double side : {-1.0, 1.0}) {
    Polygon2 outline;
    constexpr int facets = 24;
    for (int i = 0; i <= 2 * facets + 1; ++i) {
      const double radius = i <= facets ? 3.1 : 2.9;
      const double angle = side * std::numbers::pi * (i <= facets ? i : 2 * facets + 1 - i) / facets;
      outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    if (side < 0.0) std::reverse(outline.begin(), outline.end());
    const std::string wall = sketch.element("IFCWALL", sketch.shape(sketch.prism(outline, 0, 3)), "$,$");
    if (side > 0.0) sketch.door(sketch.opening(wall, sketch.box(-0.5, 2.6, 0, 0.5, 3.4, 2.1)));
  }
  return sketch;
}

TEST(CurvedWalls, EncloseTheRoomThatTheirBodiesDo) {
  const Building building = read(rotunda());
  ASSERT_EQ(building.rooms.size(), 1u);
  EXPECT_NEAR(signed_area(building.rooms.front().polygon), std::numbers::pi * 2.9 * 2.9, 0.5);
  ASSERT_EQ(building.openings.size(), 1u);
  EXPECT_EQ(std::max(building.openings.front().rooms[0], building.openings.front().rooms[1]), 0);
  EXPECT_EQ(std::min(building.openings.front().rooms[0], building.openings.front().rooms[1]), -1);
  EXPECT_TRUE(building.rooms.front().virtual_edges.empty());
}

TEST(CurvedWalls, ARoomAroundAnotherSaysThatItHoldsIt) {
  Sketch sketch = rotunda();
  for (const double y : {-5.0, 5.0}) sketch.wall(-5, y, 10, 0.2, 3);
  for (const double x : {-5.0, 5.0}) sketch.wall(x, -5, 10, 0.2, 3, true);
  const Building building = read(sketch);
  EXPECT_EQ(building.rooms.size(), 2u);
  EXPECT_EQ(count(building, "room_hole"), 1);
}

/// A corridor of 1.8 m around a core of 8 by 6 m, as a space with a void in it, and the core as a space of its own.
Sketch corridor_around_a_core() {
  Sketch sketch;
  const std::string storey = sketch.storey(0);
  sketch.slab({{-0.1, -0.1}, {12.1, -0.1}, {12.1, 10.1}, {-0.1, 10.1}}, -0.2, 0);
  const auto enclose = [&](double x0, double y0, double x1, double y1) {
    for (const double y : {y0, y1}) sketch.wall(x0, y, x1 - x0, 0.2, 3);
    for (const double x : {x0, x1}) sketch.wall(x, y0, y1 - y0, 0.2, 3, true);
  };
  enclose(0, 0, 12, 10);
  enclose(2, 2, 10, 8);
  const auto space = [&](const std::string& name, const std::string& profile) {
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
    const std::string id =
        sketch.rooted("IFCSPACE", "'" + name + "',$,$," + at + "," + sketch.shape(sketch.extruded(profile, 0, 2.8)) +
                                      ",$,.ELEMENT.,.INTERNAL.,$");
    sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + id + ")");
  };
  const std::string outer = sketch.polyline({{0.1, 0.1}, {11.9, 0.1}, {11.9, 9.9}, {0.1, 9.9}});
  const std::string inner = sketch.polyline({{1.9, 1.9}, {10.1, 1.9}, {10.1, 8.1}, {1.9, 8.1}});
  space("corridor", sketch.add("IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$," + outer + ",(" + inner + "))"));
  space("core", sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," +
                           sketch.polyline({{2.1, 2.1}, {9.9, 2.1}, {9.9, 7.9}, {2.1, 7.9}}) + ")"));
  return sketch;
}

TEST(Rooms, ASpaceThatIsARingKeepsItsHole) {
  const Building building = read(corridor_around_a_core());
  ASSERT_EQ(building.rooms.size(), 2u);
  const Room& corridor = building.rooms[0];
  ASSERT_EQ(corridor.holes.size(), 1u);
  EXPECT_NEAR(corridor.area_m2(), 11.8 * 9.8 - 8.2 * 6.2, 1e-3);
  EXPECT_TRUE(corridor.contains({1.0, 5.0}));
  EXPECT_FALSE(corridor.contains({6.0, 5.0}));
  EXPECT_NEAR(corridor.boundary_distance({1.0, 5.0}), 0.9, 1e-3);
  EXPECT_EQ(corridor.walls.size(), 8u) << "those of the core face it, too";
  EXPECT_EQ(building.rooms[1].walls.size(), 4u);
  EXPECT_EQ(count(building, "room_hole"), 0);
  EXPECT_TRUE(corridor.virtual_edges.empty());
}

TEST(Rooms, ARingIsWrittenAndReadAgain) {
  const Building building = read(corridor_around_a_core());
  const Building again = read_ifc_text(write_ifc(building), "again.ifc");
  EXPECT_EQ(again.hash(), building.hash());
  ASSERT_EQ(again.rooms.size(), 2u);
  EXPECT_EQ(again.rooms[0].holes.size(), 1u);
}

/// The standard asks for a positive depth; files with a negative one mean the other way.
TEST(Extrusions, OfNegativeDepthGoTheOtherWay) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.slab({{8, 0}, {12, 0}, {12, 6}, {8, 6}}, 0, -0.2);
  const Building building = read(sketch);
  ASSERT_EQ(building.slabs.size(), 2u);
  for (const Slab& slab : building.slabs) {
    EXPECT_NEAR(slab.z0_m, -0.2, 1e-9);
    EXPECT_NEAR(slab.z1_m, 0.0, 1e-9);
    if (slab.body) EXPECT_NEAR(volume(*slab.body), area({slab.polygon}) * 0.2, 1e-6);
  }
}

TEST(Ceilings, AreNoFloors) {
  for (const char* said : {".CEILING.", "$"}) {
    Sketch sketch;
    sketch.storey(0);
    for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
    for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
    sketch.element("IFCCOVERING", sketch.shape(sketch.box(0, 0, 2.5, 8, 6, 2.52)), std::string("$,") + said);
    const Building building = read(sketch);
    EXPECT_TRUE(building.slabs.empty()) << said;
    EXPECT_EQ(building.obstacles.size(), 1u);
    EXPECT_EQ(count(building, "no_floor"), 1);
  }
}

TEST(Rooms, AStoreyWithoutAnySaysSo) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.storey(3);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 2.8, 3);
  sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 3, 6, 0.1, 6), 6), "$,$");
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "no_rooms"), 1);
}

TEST(Sizes, ThatNoBuildingHasAreDoubted) {
  for (const double scale : {0.001, 1.0, 1000.0}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.slab({{0, 0}, {8 * scale, 0}, {8 * scale, 6 * scale}, {0, 6 * scale}}, -0.2 * scale, 0);
    sketch.wall(0, 0, 8 * scale, 0.2 * scale, 3 * scale);
    EXPECT_EQ(count(read(sketch), "odd_size"), scale == 1.0 ? 0 : 1) << scale;
  }
}

TEST(Buildings, OfWhichThereAreTwoAreToldApart) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.building = sketch.rooted("IFCBUILDING", "'c',$,$,$,$,$,.ELEMENT.,$,$,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + sketch.project + ",(" + sketch.building + ")");
  sketch.storey(0.5);
  const auto shifted = [&](double x0, double y0, double x1, double y1) {
    sketch.element("IFCWALL", sketch.shape(sketch.box(x0, y0, 0.5, x1, y1, 3.5)), "$,$");
  };
  sketch.slab({{20, 0}, {28, 0}, {28, 6}, {20, 6}}, 0.3, 0.5);
  for (const double y : {0.0, 6.0}) shifted(20, y - 0.1, 28, y + 0.1);
  for (const double x : {20.0, 28.0}) shifted(x - 0.1, 0, x + 0.1, 6);
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "several_buildings"), 1);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(building.storeys[0].name, "b: s");
  EXPECT_EQ(building.storeys[1].name, "c: s");
  EXPECT_EQ(building.storeys[0].height_m, 3.0) << "the other building's floor is no ceiling";
  ASSERT_EQ(building.rooms.size(), 3u) << "each once";
  EXPECT_EQ(std::count_if(building.rooms.begin(), building.rooms.end(), [](const Room& r) { return r.storey == 0; }),
            2);
}

TEST(Buildings, KeepWhatStandsOnALevelOfTheirsThatIsLeftOut) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.storey(1.5);  // sills
  sketch.element("IFCFURNISHINGELEMENT", sketch.shape(sketch.box(1, 1, 1.4, 2, 2, 1.8)), "$");
  sketch.building = sketch.rooted("IFCBUILDING", "'c',$,$,$,$,$,.ELEMENT.,$,$,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + sketch.project + ",(" + sketch.building + ")");
  sketch.storey(0.5);
  sketch.element("IFCWALL", sketch.shape(sketch.box(20, 0, 0.5, 28, 0.2, 3.5)), "$,$");
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  ASSERT_EQ(building.obstacles.size(), 1u);
  EXPECT_EQ(building.obstacles.front().storey, 0);
}

/// A wall along x with a door from 2 to 3 m, whose opening reaches 0.2 m beyond both of its faces.
void add_wall_with_door(Sketch& sketch) {
  sketch.storey(0);
  sketch.slab({{0, -3}, {8, -3}, {8, 3}, {0, 3}}, -0.2, 0);
  const std::string wall = sketch.wall(0, 0, 8, 0.2, 2.8);
  sketch.door(sketch.opening(wall, sketch.box(2, -0.3, 0, 3, 0.3, 2.1)));
}

/// A wall drawn along the door's, across its doorway.
TEST(StrangeBuildings, AWallInFrontOfADoorIsSaid) {
  Sketch sketch;
  add_wall_with_door(sketch);
  sketch.wall(0, 0.25, 8, 0.3, 2.8);
  const Building building = read(sketch);
  EXPECT_EQ(building.openings.size(), 1u);
  EXPECT_EQ(count(building, "blocked_door"), 1);
}

/// Plasterboard of its own before a wall with a door, on either side, with and without a gap.
TEST(StrangeBuildings, ADoorOpensTheLiningOfItsWall) {
  for (const double y : {0.15, -0.15, 0.17, 0.1125}) {
    Sketch sketch;
    add_wall_with_door(sketch);
    sketch.wall(0, y, 8, y == 0.1125 ? 0.025 : 0.1, 2.8);
    const Building building = read(sketch);
    EXPECT_EQ(building.openings.size(), 2u) << y;
    EXPECT_EQ(count(building, "walls_overlap"), 1) << y;
    EXPECT_EQ(count(building, "blocked_door"), 0) << y;
  }
}

TEST(StrangeBuildings, ADoorOpensTheCoveringOfItsWall) {
  Sketch sketch;
  add_wall_with_door(sketch);
  sketch.element("IFCCOVERING", sketch.shape(sketch.box(0, 0.1, 0, 8, 0.12, 2.8)), "$,.CLADDING.");
  sketch.element("IFCCOVERING", sketch.shape(sketch.box(0, 0.1, 0, 8, 3, 0.01)), "$,.FLOORING.");
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "walls_overlap"), 1);
  ASSERT_EQ(building.obstacles.size(), 2u);
  EXPECT_NEAR(volume(building.obstacles[0].body) + volume(building.obstacles[1].body),
              0.02 * (8 * 2.8 - 1 * 2.1) + 8 * 2.9 * 0.01, 1e-4);
}

TEST(StrangeBuildings, AThinWallApartFromTheDoorsStaysShut) {
  Sketch sketch;
  add_wall_with_door(sketch);
  sketch.wall(0, 0.25, 8, 0.1, 2.8);
  EXPECT_EQ(read(sketch).openings.size(), 1u);
  EXPECT_EQ(count(read(sketch), "blocked_door"), 1);
}

TEST(StrangeBuildings, AFreeDoorIsNotBlocked) {
  Sketch sketch;
  add_wall_with_door(sketch);
  sketch.wall(3.1, 0.1, 3, 0.1, 2.8, true);
  EXPECT_EQ(count(read(sketch), "blocked_door"), 0);
}

TEST(Columns, OneWithoutAreaOnThePlanIsAnObstacle) {
  Sketch sketch;
  two_rooms(sketch);
  const std::vector<Eigen::Vector3d> face = {{2, 3, 0}, {2.3, 3, 0}, {2.3, 3, 3}, {2, 3, 3}};
  sketch.element("IFCCOLUMN", sketch.shape(sketch.shell({face, {face.rbegin(), face.rend()}})), "$,$");
  const Building building = read(sketch);
  EXPECT_TRUE(building.columns.empty());
  EXPECT_EQ(count(building, "no_area"), 1);
  ASSERT_EQ(building.obstacles.size(), 1u);
  EXPECT_EQ(building.obstacles[0].kind, "column");
}

}  // namespace
}  // namespace plumbline::bim
