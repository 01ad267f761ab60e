// SPDX-License-Identifier: Apache-2.0
// Levels that are no storeys, storeys beside each other, and spaces that are no rooms.
#include <gtest/gtest.h>

#include <algorithm>

#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

/// A box of walls with a slab under it and a wall between two rooms, from x0 on; 8 by 6 m.
void add_house(Sketch& sketch, double x0, double z, double height, bool slab = true) {
  const auto wall = [&](double x, double y, double dx, double dy) {
    const double length = std::max(dx, dy);
    const std::string frame = dy > dx ? sketch.frame(x, y, z, "0.,0.,1.", "0.,1.,0.") : sketch.frame(x, y, z);
    sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 0, length, 0.1, height), length), "$,$", frame);
  };
  if (slab) sketch.slab({{x0, 0}, {x0 + 8, 0}, {x0 + 8, 6}, {x0, 6}}, z - 0.2, z);
  for (const double y : {0.0, 6.0}) wall(x0, y, 8, 0);
  for (const double x : {0.0, 3.0, 8.0}) wall(x0 + x, 0, 0, 6);
}

void add_room_at(Sketch& sketch, const std::string& storey, const Polygon2& outline, double z) {
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  const std::string space = sketch.rooted(
      "IFCSPACE", "'r',$,$," + at + "," + sketch.shape(sketch.prism(outline, z, z + 2.8)) + ",$,.ELEMENT.,$,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + space + ")");
}

TEST(Levels, ALevelWithoutBuildingPartsIsLeftOut) {
  Sketch plain, sills;
  for (Sketch* sketch : {&plain, &sills}) {
    sketch->storey(0);
    add_house(*sketch, 0, 0, 2.8);
    if (sketch == &sills) {
      sketch->storey(0.9);
      sketch->element("IFCFURNITURE", sketch->shape(sketch->box(1, 1, 0.9, 2, 2, 1.2)), "$,$");
    }
    sketch->storey(3);
    add_house(*sketch, 0, 3, 2.8);
  }
  const Building with = read(sills), without = read(plain);
  ASSERT_EQ(with.storeys.size(), 2u);
  EXPECT_EQ(count(with, "empty_storey"), 1);
  EXPECT_EQ(count(without, "empty_storey"), 0);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(with.storeys[i].height_m, without.storeys[i].height_m);
    EXPECT_EQ(with.storeys[i].kind, StoreyKind::habitable);
  }
  ASSERT_EQ(with.rooms.size(), 4u);
  EXPECT_EQ(std::count_if(with.rooms.begin(), with.rooms.end(), [](const Room& r) { return r.storey == 0; }), 2);
  ASSERT_EQ(with.obstacles.size(), 1u);
  EXPECT_EQ(with.obstacles.front().storey, 0) << "it stands on the storey below";
}

TEST(Levels, APartOfAStoreyAtItsHeightIsThatStorey) {
  for (const double part_m : {0.0, 1.6}) {
    Sketch sketch;
    const std::string whole = sketch.storey(0);
    add_house(sketch, 0, 0, 2.8);
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, part_m) + ")");
    const std::string part =
        sketch.rooted("IFCBUILDINGSTOREY", "'part',$,$," + at + ",$,$,.PARTIAL.," + Sketch::n(part_m));
    sketch.rooted("IFCRELAGGREGATES", "$,$," + whole + ",(" + part + ")");
    add_room_at(sketch, part, {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, part_m);
    const Building building = read(sketch);
    EXPECT_EQ(building.storeys.size(), part_m > 0.0 ? 2u : 1u);
    EXPECT_EQ(count(building, "left_out"), part_m > 0.0 ? 0 : 1);
    ASSERT_EQ(building.rooms.size(), 1u);
    EXPECT_EQ(building.rooms.front().storey, part_m > 0.0 ? 1 : 0);
    EXPECT_EQ(count(building, "no_floor"), part_m > 0.0 ? 1 : 0);
    EXPECT_EQ(building.storeys.front().kind, StoreyKind::habitable);
  }
}

TEST(Levels, AFileOfEmptyLevelsKeepsThem) {
  Sketch sketch;
  sketch.storey(0);
  sketch.element("IFCBUILDINGELEMENTPROXY", sketch.shape(sketch.box(0, 0, -0.2, 4, 4, 0)), "$,$");
  sketch.storey(3);
  sketch.element("IFCBUILDINGELEMENTPROXY", sketch.shape(sketch.box(0, 0, 2.8, 4, 4, 3)), "$,$");
  const Building building = read(sketch);
  EXPECT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(count(building, "empty_storey"), 0);
}

TEST(Levels, WhatStandsOnALevelKeepsItThoughItNamesAnother) {
  Sketch sketch;
  sketch.storey(3);
  sketch.storey(0);
  add_house(sketch, 0, 0, 2.8);
  add_house(sketch, 0, 3, 2.8);
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "empty_storey"), 0);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(building.rooms.size(), 4u);
}

TEST(Levels, RoomsOfWingsAtOneHeightAreFoundOnce) {
  Sketch sketch;
  sketch.storey(0);
  add_house(sketch, 0, 0, 3);
  sketch.storey(0.2);
  add_house(sketch, 20, 0.2, 3);
  const Building building = read(sketch);
  ASSERT_EQ(building.rooms.size(), 4u);
  for (const Room& room : building.rooms) EXPECT_EQ(room.storey, room.polygon.front().x() < 15.0 ? 0 : 1) << room.id;
}

TEST(Levels, HalfLevelsAreAsHighAsWhatLiesOverThem) {
  Sketch sketch;
  for (const int level : {0, 1, 2, 3}) {
    sketch.storey(1.4 * level);
    add_house(sketch, level % 2 == 0 ? 0.0 : 8.1, 1.4 * level, 2.6);
  }
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 4u);
  EXPECT_NEAR(building.storeys[0].height_m, 2.8, 1e-9);
  EXPECT_NEAR(building.storeys[1].height_m, 2.8, 1e-9);
  ASSERT_EQ(building.rooms.size(), 8u);
  for (int storey = 0; storey < 4; ++storey)
    EXPECT_EQ(std::count_if(building.rooms.begin(), building.rooms.end(),
                            [&](const Room& room) { return room.storey == storey; }),
              2)
        << storey;
}

/// A house of two floors that the file calls one storey: without spaces the upper one needs a door to count.
TEST(Levels, FloorsFarAboveEachOtherAreStoreysOfTheirOwn) {
  for (const bool door : {false, true}) {
    Sketch sketch;
    sketch.storey(0);
    add_house(sketch, 0, 0, 2.8);
    add_house(sketch, 0, 3, 2.8);
    if (door) {
      const std::string frame = sketch.frame(3, 3, 3);
      const std::string wall =
          sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 0, 5, 0.1, 2.8), 5), "$,$", frame);
      sketch.door(sketch.opening(wall, sketch.box(5, 2.8, 3, 6, 3.2, 5)));
    }
    sketch.element("IFCCOLUMN", sketch.shape(sketch.box(1, 1, 3, 1.3, 1.3, 5.8)), "$,$");
    const Building building = read(sketch);
    EXPECT_EQ(count(building, "split_storey"), door ? 1 : 0);
    ASSERT_EQ(building.storeys.size(), door ? 2u : 1u);
    ASSERT_EQ(building.columns.size(), 1u);
    if (!door) continue;
    EXPECT_EQ(building.storeys[1].name, "s +3 m");
    EXPECT_NEAR(building.storeys[1].elevation_m, 3.0, 1e-9);
    EXPECT_NEAR(building.storeys[0].height_m, 3.0, 1e-9);
    EXPECT_EQ(building.rooms.size(), 5u);
    EXPECT_EQ(building.columns.front().storey, 1) << "what comes later goes by its height, too";
    for (const Wall& wall : building.walls) EXPECT_EQ(wall.storey, wall.z0_m > 1.0 ? 1 : 0) << wall.id;
    for (const Slab& slab : building.slabs) EXPECT_EQ(slab.storey, slab.z1_m > 1.0 ? 1 : 0) << slab.id;
  }
}

TEST(Levels, SpacesOnAnUpperFloorOfAStoreyAreNamedAndMoved) {
  for (const bool slab : {true, false}) {
    Sketch sketch;
    const std::string storey = sketch.storey(0);
    add_house(sketch, 0, 0, 5);
    if (slab) sketch.slab({{0, 0}, {3, 0}, {3, 6}, {0, 6}}, 2.3, 2.5);
    std::string spaces;
    for (const double z : {0.0, 2.5}) {
      const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
      spaces += (spaces.empty() ? "" : ",") +
                sketch.rooted("IFCSPACE", "'" + std::string(z > 0 ? "gallery" : "hall") + "',$,$," + at + "," +
                                              sketch.shape(sketch.box(0.1, 0.1, z, 2.9, 5.9, z + 2.2)) +
                                              ",$,.ELEMENT.,.INTERNAL.,$");
    }
    sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + spaces + ")");
    const Building building = read(sketch);
    ASSERT_EQ(building.rooms.size(), 2u);
    EXPECT_EQ(building.storeys.size(), slab ? 2u : 1u) << "a space over a ceiling stands on nothing";
    for (const Warning& warning : building.warnings) {
      if (warning.kind != "split_storey") continue;
      EXPECT_NE(warning.text.find("'gallery'"), std::string::npos) << warning.text;
    }
    EXPECT_EQ(count(building, "split_storey"), slab ? 1 : 0);
    for (const Room& room : building.rooms) EXPECT_EQ(room.storey, slab && room.name == "gallery" ? 1 : 0) << room.name;
  }
}

TEST(Levels, AStoreyLiesWhereItsWallsStand) {
  Sketch sketch;
  for (const double z : {0.0, 3.0, 6.0}) {
    sketch.storey(0);
    add_house(sketch, 0, z, 2.8);
  }
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(building.storeys[i].elevation_m, 3.0 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(building.storeys[i].kind, StoreyKind::habitable);
  }
  EXPECT_EQ(building.rooms.size(), 6u);
  EXPECT_EQ(count(building, "storey_moved"), 2);
}

TEST(Levels, AStoreyWithAFloorStaysThoughItsWallsAreHigh) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  add_house(sketch, 0, 2.5, 2.8, false);
  const Building building = read(sketch);
  EXPECT_EQ(building.storeys.front().elevation_m, 0.0);
  EXPECT_EQ(count(building, "storey_moved"), 0);
}

/// The house stands at -0.6; only its storey is said to be elsewhere.
TEST(Levels, AStoreyLiesWhereItsFloorIs) {
  for (const double said : {-2.0, -1.6, -0.9, -0.3, 0.1, 0.3, 1.0, 1.4, 2.9}) {
    Sketch sketch;
    const std::string storey = sketch.storey(said);
    add_house(sketch, 0, -0.6, 3);
    add_room_at(sketch, storey, {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, -0.6);
    add_room_at(sketch, storey, {{3.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {3.1, 5.9}}, -0.6);
    const Building building = read(sketch);
    ASSERT_EQ(building.storeys.size(), 1u) << said;
    EXPECT_NEAR(building.storeys.front().elevation_m, -0.6, 1e-9) << said;
    EXPECT_EQ(building.storeys.front().kind, StoreyKind::habitable);
    EXPECT_EQ(count(building, "storey_moved"), 1) << said;
    EXPECT_EQ(count(building, "storey_kinds") + count(building, "no_floor"), 0) << said;
  }
}

TEST(Levels, ASlabAloneSaysWhereTheFloorIs) {
  Sketch sketch;
  sketch.storey(-4.1);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -5.1, -4.9);
  const Building building = read(sketch);
  EXPECT_NEAR(building.storeys.front().elevation_m, -4.9, 1e-9);
  EXPECT_EQ(count(building, "storey_moved"), 1);
}

/// Slabs of the same size under and over the rooms, and some walls that begin at the height of the storey.
TEST(Levels, ACeilingIsNoFloor) {
  for (const bool ceiling : {true, false}) {
    Sketch sketch;
    sketch.storey(0);
    add_house(sketch, 0, -1.4, 2.5);
    if (ceiling) sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 1.1, 1.3);
    for (const double y : {1.0, 2.0, 3.0, 4.0}) sketch.wall(3, y, 5, 0.2, 1.1);
    const Building building = read(sketch);
    EXPECT_NEAR(building.storeys.front().elevation_m, -1.4, 1e-9);
    EXPECT_EQ(count(building, "storey_moved"), 1);
  }
}

/// One part of the floor at the height of the storey, and a larger one lower or higher.
TEST(Levels, AStoreyOfSeveralLevelsStays) {
  for (const double other : {-1.2, -0.6, 0.4, 1.2}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.slab({{0, 0}, {5, 0}, {5, 6}, {0, 6}}, other - 0.2, other);
    sketch.slab({{5, 0}, {8, 0}, {8, 6}, {5, 6}}, -0.2, 0);
    add_house(sketch, 0, std::min(other, 0.0), 3, false);
    const Building building = read(sketch);
    EXPECT_EQ(building.storeys.front().elevation_m, 0.0) << other;
    EXPECT_EQ(count(building, "storey_moved"), 0) << other;
  }
}

/// Its covering is not drawn; doors and spaces stand on it.
TEST(Levels, ABareSlabUnderADoorOrASpaceMovesNoStorey) {
  for (const bool door : {true, false}) {
    Sketch sketch;
    const std::string storey = sketch.storey(0);
    add_house(sketch, 0, -0.2, 3);
    if (door) {
      const std::string wall = sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 0, 5, 0.1, 2.8), 5),
                                              "$,$", sketch.frame(3, 3, -0.2));
      sketch.door(sketch.opening(wall, sketch.box(5, 2.8, 0, 6, 3.2, 2)));
    } else {
      add_room_at(sketch, storey, {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, 0);
    }
    const Building building = read(sketch);
    EXPECT_EQ(building.storeys.front().elevation_m, 0.0);
    EXPECT_EQ(count(building, "storey_moved"), 0);
  }
}

/// A slab of the floor above that a program gives to the storey below.
TEST(Levels, ASlabAloneMovesNoStoreyToAnother) {
  Sketch sketch;
  sketch.storey(-1);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  sketch.storey(0.1);
  add_house(sketch, 0, 0.1, 3, false);
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(building.storeys.front().elevation_m, -1.0);
  EXPECT_EQ(count(building, "storey_moved"), 0);
}

/// Some programs write containment where the standard has aggregation.
TEST(Spaces, OneThatIsContainedInAStoreyBelongsToIt) {
  Sketch sketch;
  sketch.storey(0);
  add_house(sketch, 0, 0, 2.8);
  const std::string upper = sketch.storey(3);
  add_house(sketch, 0, 3, 2.8);
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  // By its height it would be a room of the lower storey.
  const std::string space = sketch.rooted(
      "IFCSPACE", "'a',$,$," + at + "," + sketch.shape(sketch.box(0.1, 0.1, 2.4, 2.9, 5.9, 5.6)) + ",$,.ELEMENT.,$,$");
  sketch.rooted("IFCRELCONTAINEDINSPATIALSTRUCTURE", "$,$,(" + space + ")," + upper);
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  ASSERT_EQ(building.rooms.size(), 1u);
  EXPECT_EQ(building.rooms.front().storey, 1);
}

std::string add_space(Sketch& sketch, const std::string& storey, const std::string& name, const Polygon2& outline,
                      const std::string& type) {
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  const std::string id =
      sketch.rooted("IFCSPACE", "'" + name + "',$,$," + at + "," + sketch.shape(sketch.prism(outline, 0, 2.8)) +
                                    ",$,.ELEMENT.," + type + ",$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + id + ")");
  return id;
}

TEST(Spaces, GrossAreasAndTerracesAreNoRooms) {
  Sketch sketch;
  const std::string storey = sketch.storey(0);
  add_house(sketch, 0, 0, 2.8);
  add_space(sketch, storey, "a", {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, ".INTERNAL.");
  add_space(sketch, storey, "b", {{3.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {3.1, 5.9}}, "$");
  add_space(sketch, storey, "gross", {{-0.1, -0.1}, {8.1, -0.1}, {8.1, 6.1}, {-0.1, 6.1}}, ".GFA.");
  add_space(sketch, storey, "terrace", {{8.1, 0}, {12, 0}, {12, 6}, {8.1, 6}}, ".EXTERNAL.");
  const Building building = read(sketch);
  ASSERT_EQ(building.rooms.size(), 2u);
  EXPECT_EQ(building.rooms[0].name, "a");
  EXPECT_EQ(building.rooms[1].name, "b");
  EXPECT_EQ(count(building, "not_a_room"), 1);
}

/// Only the ground floor has spaces, and the upper one has no slab either; its door says that people walk there.
TEST(Spaces, AStoreyWithoutThemHasTheRoomsThatItsWallsEnclose) {
  Sketch sketch;
  const std::string ground = sketch.storey(0);
  add_house(sketch, 0, 0, 2.8);
  add_space(sketch, ground, "a", {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, ".INTERNAL.");
  add_space(sketch, ground, "b", {{3.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {3.1, 5.9}}, ".INTERNAL.");
  sketch.storey(3);
  add_house(sketch, 0, 3, 2.8, false);
  const std::string box = sketch.box(0, -0.1, 0, 6, 0.1, 2.8);
  const std::string wall =
      sketch.element("IFCWALL", sketch.wall_shape(box, 6), "$,$", sketch.frame(5.5, 0, 3, "0.,0.,1.", "0.,1.,0."));
  sketch.door(sketch.opening(wall, sketch.box(5.3, 2, 3, 5.7, 3, 5.1)));
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(building.storeys[1].kind, StoreyKind::habitable);
  EXPECT_EQ(building.rooms.size(), 5u);
  EXPECT_EQ(count(building, "inferred_room"), 3);
}

TEST(Spaces, OneThatCoversAllOthersIsNoRoom) {
  for (const bool second : {true, false}) {
    Sketch sketch;
    const std::string storey = sketch.storey(0);
    add_house(sketch, 0, 0, 2.8);
    add_space(sketch, storey, "a", {{0.1, 0.1}, {2.9, 0.1}, {2.9, 5.9}, {0.1, 5.9}}, "$");
    if (second) add_space(sketch, storey, "b", {{3.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {3.1, 5.9}}, "$");
    add_space(sketch, storey, "all", {{0.1, 0.1}, {7.9, 0.1}, {7.9, 5.9}, {0.1, 5.9}}, "$");
    const Building building = read(sketch);
    EXPECT_EQ(building.rooms.size(), 2u) << "a hall with one room in it is kept";
    EXPECT_EQ(count(building, "not_a_room"), second ? 1 : 0);
  }
}

}  // namespace
}  // namespace plumbline::bim
