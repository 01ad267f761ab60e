// SPDX-License-Identifier: Apache-2.0
// What exporters write beside walls and rooms: a level for the top of each slab, provisions for voids, terrain, wells.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/floors.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

void add_space(Sketch& sketch, const std::string& storey, double z0, double z1) {
  const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")");
  const std::string id =
      sketch.rooted("IFCSPACE", "'room',$,$," + at + "," + sketch.shape(sketch.box(0.1, 0.1, z0, 7.9, 5.9, z1)) +
                                    ",$,.ELEMENT.,.INTERNAL.,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + storey + ",(" + id + ")");
}

/// One room over another, each on a slab whose top is a level of its own this far below; slabs and walls hang on those,
/// rooms on the levels of the finished floors. A stair leads from slab to slab, or from floor to floor.
Sketch two_levels_a_floor(double below_m, bool stair_on_floors) {
  constexpr int steps = 17;
  Sketch sketch;
  const double rise = 3.0 / steps, foot = stair_on_floors ? 0.0 : -below_m;
  std::string items;
  for (int k = 0; k < steps; ++k)
    items += (k > 0 ? "," : "") +
             sketch.box(1 + 0.28 * k, 2, foot + rise * k, 1 + 0.28 * (k + 1), 3.1, foot + rise * (k + 1));
  for (const double z : {0.0, 3.0}) {
    const double slab_m = z - below_m;
    sketch.storey(slab_m);
    const std::string slab = sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, slab_m - 0.2, slab_m);
    if (z > 0.0) sketch.opening(slab, sketch.box(0.9, 1.9, 2.0, 1 + 0.28 * steps, 3.2, 3.2));
    for (const double y : {0.0, 6.0})
      sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, y - 0.1, slab_m, 8, y + 0.1, slab_m + 2.8), 8), "$,$");
    if (z == 0.0) sketch.element("IFCSTAIR", sketch.shape(items), "$,$");
    add_space(sketch, sketch.storey(z), z, z + 2.6);
  }
  return sketch;
}

TEST(LevelsOfSlabs, AStairLeadsFromRoomToRoomAndTheirStoreysAreHabitable) {
  for (const double below_m : {0.05, 0.1, 0.2})
    for (const bool on_floors : {true, false}) {
      SCOPED_TRACE(std::to_string(below_m) + (on_floors ? ", stair on floors" : ", stair on slabs"));
      const Building building = read(two_levels_a_floor(below_m, on_floors));
      ASSERT_EQ(building.storeys.size(), 4u);
      ASSERT_EQ(building.rooms.size(), 2u);
      ASSERT_EQ(building.stairs.size(), 1u);
      EXPECT_EQ(building.stairs.front().from, building.rooms[0].storey);
      EXPECT_EQ(building.stairs.front().to, building.rooms[1].storey);
      for (const Room& room : building.rooms)
        EXPECT_EQ(building.storeys[static_cast<std::size_t>(room.storey)].kind, StoreyKind::habitable);
    }
}

TEST(Provisions, ForVoidsAreNoMatter) {
  for (const std::string schema : {"IFC4", "IFC2X3"}) {
    Sketch sketch;
    sketch.schema = schema;
    const std::string wall = two_rooms(sketch);
    sketch.door(sketch.opening(wall, sketch.box(3.5, 2.5, 0, 4.5, 3.5, 2.1)));
    const std::string type = schema == "IFC4" ? ".PROVISIONFORVOID." : "$";
    sketch.element("IFCBUILDINGELEMENTPROXY", sketch.shape(sketch.box(3, 2.8, 0.2, 5, 3.2, 1.5)), "$," + type);
    sketch.element("IFCBUILDINGELEMENTPROXY", sketch.shape(sketch.box(6, 4, 0, 7, 5, 1)), "$,$");
    std::string text = sketch.text();
    if (schema == "IFC2X3") text.replace(text.find("PROXY',$,$"), 10, "PROXY',$,'Provision for void'");
    const Building building = read_ifc_text(text, "s.ifc");
    ASSERT_EQ(building.obstacles.size(), 1u) << "the other proxy";
    EXPECT_EQ(building.obstacles.front().kind, "proxy");
    EXPECT_EQ(count(building, "left_out"), 1);
  }
}

TEST(Terrain, IsLeftOutWhateverItsClass) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.element("IFCGEOGRAPHICELEMENT", sketch.shape(sketch.box(-20, -20, -1, 20, 20, 0.4)), "$,.TERRAIN.");
  const Building building = read(sketch);
  EXPECT_TRUE(building.obstacles.empty());
  EXPECT_EQ(count(building, "left_out"), 1);
}

TEST(Headers, MayBreakTheLineWithinTheSchema) {
  Sketch sketch;
  two_rooms(sketch);
  const std::string text = sketch.text(), said = "FILE_SCHEMA(('IFC4'))";
  for (const std::string other :
       {"FILE_SCHEMA\n(('IFC4'))", "FILE_SCHEMA((\r\n'IFC4'\r\n))", "FILE_SCHEMA ( ( 'IFC4' ) )"}) {
    std::string broken = text;
    broken.replace(broken.find(said), said.size(), other);
    EXPECT_EQ(read_ifc_text(broken, "s.ifc").walls.size(), 5u) << other;
  }
}

TEST(Wells, InASlabLeaveARoomItsFloor) {
  Sketch sketch;
  const std::string storey = sketch.storey(0);
  const std::string slab = sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  sketch.opening(slab, sketch.box(1, 1, -0.5, 7, 5.2, 0.5));  // more than half of the room
  for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
  add_space(sketch, storey, 0, 2.8);
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "no_floor"), 0);
  for (const FloorPiece& piece : floor_pieces(building)) {
    EXPECT_EQ(piece.source, FloorSource::slab);
    EXPECT_FALSE(contains(piece.polygon, Eigen::Vector2d(4, 3))) << "in the well";
  }
}

TEST(Spaces, WithoutABodyAreNotSaidToBeMissing) {
  for (const bool with_spaces : {true, false}) {
    Sketch sketch;
    two_rooms(sketch);
    if (with_spaces) sketch.element("IFCSPACE", "$", "$,.ELEMENT.,.INTERNAL.,$");
    const Building building = read(sketch);
    const auto said = std::find_if(building.warnings.begin(), building.warnings.end(),
                                   [](const Warning& warning) { return warning.kind == "inferred_room"; });
    ASSERT_NE(said, building.warnings.end());
    EXPECT_EQ(said->text, with_spaces ? "no space of the file has a body that can be read; walls enclose this"
                                      : "the file has no spaces; walls enclose this");
  }
}

/// Some exporters give spaces as outlines or boxes alone.
TEST(Spaces, WithoutABodyNameTheRoomThatTheyLieIn) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.bare_space("east", "FootPrint", sketch.polyline({{4.3, 0.3}, {4.3, 5.7}, {7.7, 5.7}, {7.7, 0.3}}));
  sketch.bare_space("west", "Box", sketch.add("IFCBOUNDINGBOX(" + sketch.point(0.2, 0.2, 0) + ",3.5,5.5,2.8)"));
  sketch.bare_space("above", "FootPrint", sketch.polyline({{0.3, 0.3}}));
  sketch.bare_space("afar", "FootPrint", sketch.polyline({{14.3, 0.3}, {17.7, 0.3}, {17.7, 5.7}}));
  const Building building = read(sketch);
  std::map<std::string, double> middles;
  for (const Room& room : building.rooms) middles[room.name] = interior_point(room.polygon).x();
  ASSERT_EQ(middles.size(), 2u);
  EXPECT_LT(middles.at("west"), 4.0);
  EXPECT_GT(middles.at("east"), 4.0);
}

TEST(Spaces, WithoutABodyAreRoomsByTheirOutlinesBesideOthersWithOne) {
  for (const bool box : {true, false}) {
    Sketch sketch;
    two_rooms(sketch);
    const std::string outline = box ? sketch.add("IFCBOUNDINGBOX(" + sketch.point(4, 0, 0) + ",4.,6.,2.8)")
                                    : sketch.polyline({{4, 0}, {8, 0}, {8, 6}, {4, 6}});
    sketch.bare_space("office", box ? "Box" : "FootPrint", outline);
    sketch.bare_space("kitchen", "Body", sketch.box(0.1, 0.1, 0, 3.85, 5.9, 2.8));
    const Building building = read(sketch);
    ASSERT_EQ(building.rooms.size(), 2u);
    const Room& office = building.rooms[building.rooms[0].name == "office" ? 0 : 1];
    EXPECT_EQ(office.name, "office");
    EXPECT_NEAR(office.area_m2(), 3.75 * 5.8, 1e-6) << "to the faces of the walls";
    EXPECT_NEAR(office.z1_m, 3.0, 1e-6);
    EXPECT_EQ(count(building, "inferred_room"), 1);
  }
}

/// A hall of 7.8 by 5.8 m without walls in it.
void one_hall(Sketch& sketch) {
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  for (const double y : {0.0, 6.0}) sketch.wall(0, y, 8, 0.2, 3);
  for (const double x : {0.0, 8.0}) sketch.wall(x, 0, 6, 0.2, 3, true);
}

const Room& room_named(const Building& building, const std::string& name) {
  const auto found =
      std::find_if(building.rooms.begin(), building.rooms.end(), [&](const Room& room) { return room.name == name; });
  if (found == building.rooms.end()) throw std::runtime_error("no room " + name);
  return *found;
}

TEST(Spaces, WithoutABodyAreRoomsInTheHoleOfAnother) {
  Sketch sketch;
  one_hall(sketch);
  sketch.bare_space("ring", "Body",
                    sketch.difference(sketch.box(0.1, 0.1, 0, 7.9, 5.9, 2.8), sketch.box(3, 2, -1, 5, 4, 4)));
  sketch.bare_space("core", "FootPrint", sketch.polyline({{2.8, 1.8}, {5, 1.8}, {5, 4}, {2.8, 4}}));
  const Building building = read(sketch);
  ASSERT_EQ(building.rooms.size(), 2u);
  EXPECT_NEAR(room_named(building, "core").area_m2(), 4.0, 1e-6);
  EXPECT_NEAR(room_named(building, "ring").area_m2(), 7.8 * 5.8 - 4.0, 1e-6);
}

TEST(Spaces, WithoutABodyGoRoundTheRoomsWithin) {
  for (const double x : {1.0, 3.0})  // beside the middle of the hall and in it
    for (const bool walls : {false, true}) {
      SCOPED_TRACE(std::to_string(x) + (walls ? ", walls" : ""));
      Sketch sketch;
      one_hall(sketch);
      sketch.bare_space("hall", "FootPrint", sketch.polyline({{0, 0}, {8, 0}, {8, 6}, {0, 6}}));
      sketch.bare_space("office", "Body", sketch.box(x, 2, 0, x + 2, 4, 2.8));
      if (walls) {
        for (const double y : {1.95, 4.05}) sketch.wall(x - 0.1, y, 2.2, 0.1, 3);
        for (const double wall_x : {x - 0.05, x + 2.05}) sketch.wall(wall_x, 2, 2, 0.1, 3, true);
      }
      const Building building = read(sketch);
      ASSERT_EQ(building.rooms.size(), 2u);
      const Room& hall = room_named(building, "hall");
      EXPECT_FALSE(hall.contains({x + 1, 3}));
      EXPECT_NEAR(hall.area_m2(), 7.8 * 5.8 - (walls ? 2.2 * 2.2 : 4.0), 1e-6);
    }
}

TEST(Spaces, WithoutABodyThatCoverOthersAreNoRooms) {
  for (const bool bodies : {true, false}) {
    Sketch sketch;
    two_rooms(sketch);
    const double top_m = bodies ? 4.9 : 4.7;  // what is left above the kitchen is no room
    sketch.bare_space("flat", "FootPrint", sketch.polyline({{0, 0}, {8, 0}, {8, 6}, {0, 6}}));
    sketch.bare_space("office", "Body", sketch.box(4.15, 0.1, 0, 7.9, 5.9, 2.8));
    if (bodies)
      sketch.bare_space("kitchen", "Body", sketch.box(0.1, 0.1, 0, 3.85, top_m, 2.8));
    else
      sketch.bare_space("kitchen", "FootPrint", sketch.polyline({{0, 0}, {3.9, 0}, {3.9, top_m}, {0, top_m}}));
    const Building building = read(sketch);
    ASSERT_EQ(building.rooms.size(), 2u);
    EXPECT_EQ(room_named(building, "kitchen").polygon.size(), 4u);
    EXPECT_EQ(room_named(building, "office").polygon.size(), 4u);
  }
}

TEST(Spaces, WithoutABodyAreSaidToBeLeftOutWhereTheyAre) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.bare_space("", "FootPrint", sketch.polyline({{4, 0}, {8, 0}, {8, 6}, {4, 6}}));
  sketch.bare_space("bow", "FootPrint", sketch.polyline({{4.3, 0.3}, {7.7, 5.7}, {7.7, 0.3}, {4.3, 5.7}}));
  sketch.bare_space("twin", "FootPrint", sketch.polyline({{0.2, 0.2}, {3.8, 0.2}, {3.8, 5.8}, {0.2, 5.8}}));
  sketch.bare_space("kitchen", "Body", sketch.box(0.1, 0.1, 0, 3.85, 5.9, 2.8));
  const Building building = read(sketch);
  EXPECT_EQ(building.rooms.size(), 2u) << "one needs no name";
  EXPECT_EQ(count(building, "inferred_room"), 1);
  EXPECT_EQ(count(building, "no_body"), 3);
  const auto left_out = [](const Warning& w) {
    return w.kind == "no_body" && w.text.find("left out") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(building.warnings.begin(), building.warnings.end(), left_out), 2);
}

TEST(SheetWalls, AreCutByOpeningsThatCrossThem) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, -0.2, 0);
  const std::string face = sketch.shell({{{0, 3, 0}, {8, 3, 0}, {8, 3, 3}}, {{0, 3, 0}, {8, 3, 3}, {0, 3, 3}}});
  const std::string wall = sketch.element("IFCWALL", sketch.shape(face), "$,$");
  sketch.door(sketch.opening(wall, sketch.box(3, 2.8, 0, 4, 3.2, 2.1)));
  sketch.door(sketch.opening(wall, sketch.box(5, 4.8, 0, 6, 5.2, 2.1)));
  EXPECT_EQ(count(read(sketch), "opening_unused"), 1) << "the second one misses it";
}

TEST(Names, OfCharactersBeyondTheFirstPlaneAreDecoded) {
  Sketch sketch;
  two_rooms(sketch);
  const std::string text = sketch.text();
  const auto named = [&](const std::string& name) {
    std::string other = text;
    const std::size_t at = other.find("'s'", other.find("IFCBUILDINGSTOREY"));
    return read_ifc_text(other.replace(at, 3, "'" + name + "'"), "s.ifc").storeys.front().name;
  };
  EXPECT_EQ(named("\\X4\\0001F3E0000000E9\\X0\\ 1"), "🏠é 1");
  for (const char* odd : {"\\X4\\0001F3\\X0\\", "\\X4\\0001F3E0", "\\X4\\FFFFFFFF\\X0\\", "\\X4\\\\X0\\"})
    EXPECT_EQ(named(std::string("a") + odd).front(), 'a') << odd;
}

}  // namespace
}  // namespace plumbline::bim
