// SPDX-License-Identifier: Apache-2.0
// Spaces and elements that a file holds twice.
#include <gtest/gtest.h>

#include <algorithm>

#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

void add_space(Sketch& sketch, const std::string& storey, const std::string& name, const std::string& item) {
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  const std::string id =
      sketch.rooted("IFCSPACE", "'" + name + "',$,$," + at + "," + sketch.shape(item) + ",$,.ELEMENT.,.INTERNAL.,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + id + ")");
}

/// Walls of two rooms with a door between them, a little farther along x.
void add_walls(Sketch& sketch, double shift) {
  for (const double y : {0.0, 6.0}) sketch.wall(shift, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x + shift, 0, 6, 0.2, 3, true);
  const std::string middle = sketch.wall(4 + shift, 0, 6, 0.3, 3, true);
  sketch.door(sketch.opening(middle, sketch.box(3.8 + shift, 2, 0, 4.2 + shift, 3, 2.1)));
}

TEST(Doubles, SpacesInOnePlaceAreOneRoom) {
  for (const double wider : {0.0, -0.05, 0.1}) {
    Sketch sketch;
    const std::string storey = sketch.storey(0);
    sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
    add_walls(sketch, 0.0);
    for (const bool again : {false, true}) {
      const std::string more = again ? "_area" : "";
      const double by = again ? wider : 0.0;
      add_space(sketch, storey, "west" + more, sketch.box(0.1 - by, 0.1 - by, 0, 3.85 + by, 5.9 + by, 2.8));
      add_space(sketch, storey, "east" + more, sketch.box(4.15 - by, 0.1 - by, 0, 7.9 + by, 5.9 + by, 2.8));
    }
    const Building building = read(sketch);
    ASSERT_EQ(building.rooms.size(), 2U) << wider;
    EXPECT_EQ(count(building, "double_space"), 2);
    for (const Room& room : building.rooms)
      EXPECT_FALSE(room.name.ends_with("_area")) << "the one that ends at the walls, or else the first";
    for (const Warning& warning : building.warnings) {
      if (warning.kind != "double_space") continue;
      EXPECT_NE(warning.text.find("t' ("), std::string::npos) << warning.text;
      EXPECT_NE(warning.text.find("t_area' ("), std::string::npos) << warning.text;
    }
    ASSERT_EQ(adjacency(building).size(), 1U) << wider;
  }
}

/// Ids are made at random.
TEST(Doubles, OfEqualSpacesTheFirstOfTheFileIsTheRoom) {
  for (const bool swapped : {false, true}) {
    Sketch sketch;
    const std::string storey = sketch.storey(0);
    sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
    add_walls(sketch, 0.0);
    for (const bool again : {false, true}) {
      const std::string id(22, again == swapped ? 'a' : 'b'), name = again ? "second" : "first";
      const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
      const std::string shape = sketch.shape(sketch.box(0.1, 0.1, 0, 3.85, 5.9, 2.8));
      const std::string space =
          sketch.add("IFCSPACE('" + id + "',$,'" + name + "',$,$," + at + "," + shape + ",$,.ELEMENT.,.INTERNAL.,$)");
      sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + space + ")");
    }
    const Building building = read(sketch);
    ASSERT_EQ(count(building, "double_space"), 1);
    const auto named = [](const char* name) { return [name](const Room& room) { return room.name == name; }; };
    EXPECT_TRUE(std::any_of(building.rooms.begin(), building.rooms.end(), named("first"))) << swapped;
    EXPECT_FALSE(std::any_of(building.rooms.begin(), building.rooms.end(), named("second"))) << swapped;
  }
}

TEST(Doubles, ACorridorAroundACoreIsNotInItsPlace) {
  Sketch sketch;
  const std::string storey = sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  add_walls(sketch, 0.0);
  const std::string outer = sketch.polyline({{0.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {0.1, 5.9}});
  const std::string inner = sketch.polyline({{1, 1}, {7, 1}, {7, 5}, {1, 5}});
  add_space(
      sketch, storey, "corridor",
      sketch.extruded(sketch.add("IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$," + outer + ",(" + inner + "))"), 0, 2.8));
  add_space(sketch, storey, "core", sketch.box(1.1, 1.1, 0, 6.9, 4.9, 2.8));
  const Building building = read(sketch);
  EXPECT_EQ(building.rooms.size(), 2U);
  EXPECT_EQ(count(building, "double_space"), 0);
}

TEST(Doubles, ElementsDrawnTwiceCountOnce) {
  for (const double shift : {0.0, 5e-4, 0.01}) {
    Sketch once, twice;
    for (Sketch* sketch : {&once, &twice}) {
      const std::string storey = sketch->storey(0);
      sketch->slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
      add_space(*sketch, storey, "west", sketch->box(0.1, 0.1, 0, 3.85, 5.9, 2.8));
      add_space(*sketch, storey, "east", sketch->box(4.15, 0.1, 0, 7.9, 5.9, 2.8));
      add_walls(*sketch, 0.0);
      if (sketch == &twice) add_walls(*sketch, shift);
    }
    const Building single = read(once), both = read(twice);
    EXPECT_EQ(count(single, "drawn_twice"), 0);
    if (shift > 1e-3) {
      EXPECT_EQ(both.walls.size(), 10U);
      EXPECT_EQ(count(both, "drawn_twice"), 0);
      continue;
    }
    EXPECT_EQ(count(both, "drawn_twice"), 7) << "five walls, an opening and its door";
    EXPECT_EQ(both.walls.size(), single.walls.size());
    EXPECT_EQ(both.openings.size(), single.openings.size());
    EXPECT_EQ(both.warnings.size(), single.warnings.size() + 7);
    ASSERT_EQ(both.rooms.size(), 2U);
    EXPECT_EQ(adjacency(both).size(), 1U);
    const auto named = std::find_if(both.warnings.begin(), both.warnings.end(), [&](const Warning& warning) {
      return warning.kind == "drawn_twice" && warning.text.find(both.walls.front().id) != std::string::npos;
    });
    EXPECT_NE(named, both.warnings.end());
  }
}

/// The first has no opening, and what is cut out of the other is cut out of it.
TEST(Doubles, TheDoorOfTheOneThatIsLeftOutIsKept) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  sketch.wall(4, 0, 6, 0.3, 3, true);
  add_walls(sketch, 0.0);
  const Building building = read(sketch);
  EXPECT_EQ(building.walls.size(), 5U);
  ASSERT_EQ(building.openings.size(), 1U);
  EXPECT_EQ(building.openings.front().kind, OpeningKind::door);
  EXPECT_EQ(count(building, "drawn_twice"), 1);
  EXPECT_EQ(count(building, "opening_unused"), 0);
}

}  // namespace
}  // namespace plumbline::bim
