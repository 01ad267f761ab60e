// SPDX-License-Identifier: Apache-2.0
// Rooms of files without spaces, from their walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/sketch.h"
#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

Building read_sketch(const Sketch& sketch) { return read_ifc_text(sketch.text(), "s.ifc"); }

bool has_warning(const Building& building, const std::string& kind) {
  return std::any_of(building.warnings.begin(), building.warnings.end(),
                     [&](const Warning& warning) { return warning.kind == kind; });
}

/// Four walls around a rectangle; the one along its lower edge.
std::string enclose(Sketch& sketch, double x0, double y0, double x1, double y1) {
  std::string lower = sketch.wall(x0, y0, x1 - x0, 0.2, 3);
  sketch.wall(x0, y1, x1 - x0, 0.2, 3);
  sketch.wall(x0, y0, y1 - y0, 0.2, 3, true);
  sketch.wall(x1, y0, y1 - y0, 0.2, 3, true);
  return lower;
}

/// The outline of the room around the core holds the core too.
TEST(InferredRooms, ADoorOfACoreThatStandsFreeLeadsIntoIt) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-0.1, -0.1}, {12.1, -0.1}, {12.1, 10.1}, {-0.1, 10.1}}, -0.2, 0);
  enclose(sketch, 0, 0, 12, 10);
  const std::string wall = enclose(sketch, 4, 4, 8, 7);
  sketch.door(sketch.opening(wall, sketch.box(5.5, 3.8, 0, 6.4, 4.2, 2.1)));
  const Building building = read_sketch(sketch);
  ASSERT_EQ(building.rooms.size(), 2u);
  ASSERT_EQ(building.openings.size(), 1u);
  const int* rooms = building.openings.front().rooms;
  EXPECT_EQ(std::min(rooms[0], rooms[1]), 0);
  EXPECT_EQ(std::max(rooms[0], rooms[1]), 1);
  EXPECT_TRUE(has_warning(building, "room_hole"));
  EXPECT_FALSE(has_warning(building, "door_unresolved"));
}

/// A front of two plates with a door between them closes the room behind it.
TEST(InferredRooms, EndAtADoorBetweenThePanelsOfAFront) {
  for (const bool has_door : {true, false}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.slab({{-0.1, -0.1}, {8.1, -0.1}, {8.1, 6.1}, {-0.1, 6.1}}, -0.2, 0);
    sketch.wall(0, 6, 8, 0.2, 3);
    for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
    for (const auto& [from, to] : {std::pair(0.1, 3.0), std::pair(4.0, 7.9)})
      sketch.element("IFCPLATE", sketch.shape(sketch.box(from, -0.03, 0, to, 0.03, 3)), "$,$");
    if (has_door) sketch.element("IFCDOOR", sketch.shape(sketch.box(3, -0.03, 0, 4, 0.03, 2.1)), "$,2.1,1.,$,$,$");
    const Building building = read_sketch(sketch);
    EXPECT_EQ(has_warning(building, "door_without_wall"), has_door);
    ASSERT_EQ(building.rooms.size(), has_door ? 1u : 0u);
    if (has_door) EXPECT_NEAR(building.rooms.front().area_m2(), 7.8 * 5.87, 0.01);
  }
}

/// Knee walls end below the height at which walls are cut; the walls of a terrace do too.
TEST(InferredRooms, LieBehindKneeWallsUnderARoof) {
  for (const bool has_roof : {true, false}) {
    Sketch sketch;
    sketch.storey(0);
    const Polygon2 outline = {{-0.1, -0.1}, {8.1, -0.1}, {8.1, 6.1}, {-0.1, 6.1}};
    sketch.slab(outline, -0.2, 0);
    for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 0.7);
    for (const double x : {0.0, 5.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
    if (has_roof) sketch.element("IFCSLAB", sketch.shape(sketch.prism(outline, 3, 3.2)), "$,.ROOF.");
    const Building building = read_sketch(sketch);
    EXPECT_EQ(has_warning(building, "no_rooms"), !has_roof);
    EXPECT_EQ(building.rooms.size(), has_roof ? 2u : 0u);
    if (has_roof) EXPECT_NEAR(building.rooms[0].area_m2() + building.rooms[1].area_m2(), 7.6 * 5.8, 0.01);
  }
}

TEST(InferredRooms, OfALargeStoreyAreFoundInTime) {
  constexpr int across = 36;
  constexpr double room_m = 4.0;
  Sketch sketch;
  sketch.storey(0);
  for (int i = 0; i <= across; ++i) {
    sketch.wall(0, room_m * i, room_m * across, 0.2, 3);
    sketch.wall(room_m * i, 0, room_m * across, 0.2, 3, true);
  }
  const std::string text = sketch.text();
  const std::clock_t begin = std::clock();
  const Building building = read_ifc_text(text, "s.ifc");
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5.0 * slower);  // CPU time
  EXPECT_EQ(building.rooms.size(), static_cast<std::size_t>(across * across));
  EXPECT_FALSE(has_warning(building, "room_hole"));
}

}  // namespace
}  // namespace plumbline::bim
