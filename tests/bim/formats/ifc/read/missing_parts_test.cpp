// SPDX-License-Identifier: Apache-2.0
// Buildings as other programs write them, with parts, references or entities that are missing or of another schema.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
#include "bim/model/floors.h"
#include "tests/bim/formats/ifc/sketch.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

Building read_sketch(const Sketch& sketch) { return read_ifc_text(sketch.text(), "s.ifc"); }

int warnings_of(const Building& building, const std::string& kind) {
  return static_cast<int>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                        [&](const Warning& w) { return w.kind == kind; }));
}

/// Floor, four walls and a door, with walls, slab and storey only where asked for.
struct Parts {
  std::string wall = "IFCWALL", slab = "IFCSLAB";
  bool storey = true;
};

Sketch hut(const Parts& parts) {
  Sketch sketch;
  if (parts.storey) sketch.storey(0);
  const auto element = [&](const std::string& type, const std::string& item) {
    if (type.empty()) return;
    sketch.element(type, sketch.shape(item), type == "IFCBUILTELEMENT" ? "$" : "$,$");
  };
  element(parts.slab, sketch.box(0, 0, -0.2, 6, 4, 0));
  element(parts.wall, sketch.box(0, 0, 0, 6, 0.2, 3));
  element(parts.wall, sketch.box(0, 3.8, 0, 6, 4, 3));
  element(parts.wall, sketch.box(0, 0.2, 0, 0.2, 3.8, 3));
  element(parts.wall, sketch.box(5.8, 0.2, 0, 6, 3.8, 3));
  return sketch;
}

constexpr double hut_area_m2 = 5.6 * 3.6;

double inner_area(const Building& building) {
  double sum = 0.0;
  for (const Room& room : building.rooms) sum += signed_area(room.polygon);
  return sum;
}

TEST(Missing, WallsAreTakenFromWhatStandsLikeThem) {
  for (const char* type : {"IFCBUILDINGELEMENTPROXY", "IFCPLATE"}) {
    const Building building = read_sketch(hut({.wall = type}));
    EXPECT_EQ(building.walls.size(), 4u) << type;
    EXPECT_EQ(warnings_of(building, "taken_as_wall"), 4);
    EXPECT_NEAR(inner_area(building), hut_area_m2, 1e-3);
  }
}

TEST(Missing, SlabsAreTakenFromWhatLiesLikeThem) {
  for (const char* type : {"IFCBUILDINGELEMENTPROXY", "IFCPLATE", "IFCFOOTING", "IFCCOVERING"}) {
    const Building building = read_sketch(hut({.slab = type}));
    ASSERT_EQ(building.slabs.size(), 1u) << type;
    EXPECT_EQ(warnings_of(building, "taken_as_slab"), 1);
    EXPECT_EQ(warnings_of(building, "no_floor"), 0);
  }
}

TEST(Missing, ASuspendedCeilingIsNoFloor) {
  Sketch sketch = hut({.slab = ""});
  sketch.element("IFCCOVERING", sketch.shape(sketch.box(0.2, 0.2, 2.58, 5.8, 3.8, 2.6)), "$,.CEILING.");
  const Building building = read_sketch(sketch);
  EXPECT_TRUE(building.slabs.empty());
  EXPECT_EQ(building.obstacles.size(), 1u);
  EXPECT_EQ(warnings_of(building, "no_floor"), 1);
}

TEST(Missing, ARoofAloneIsNoFloorAndItIsSaid) {
  Sketch sketch;
  sketch.storey(0);
  sketch.wall(0, 0, 8, 0.2, 3);
  sketch.slab({{0, 0}, {8, 0}, {8, 5}, {0, 5}}, 3, 3.25);
  const Building building = read_sketch(sketch);
  EXPECT_EQ(building.storeys.front().elevation_m, 0.0);
  EXPECT_EQ(warnings_of(building, "no_floor"), 1);
}

TEST(Missing, WithoutSlabsTheRoomsCarryAndItIsSaid) {
  const Building building = read_sketch(hut({.slab = ""}));
  EXPECT_EQ(warnings_of(building, "no_floor"), 1);
  const std::vector<FloorPiece> floors = floor_pieces(building);
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_EQ(floors.front().source, FloorSource::room);
  EXPECT_NEAR(area({floors.front().polygon}), hut_area_m2, 1e-3);
}

TEST(Missing, StoreysAreWhereWallsBegin) {
  Sketch sketch = hut({.storey = false});
  sketch.element("IFCWALL", sketch.shape(sketch.box(0, 0, 3.2, 6, 0.2, 6)), "$,$");
  const Building building = read_sketch(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_NEAR(building.storeys[0].elevation_m, 0.0, 1e-9);
  EXPECT_NEAR(building.storeys[1].elevation_m, 3.2, 1e-9);
  EXPECT_EQ(warnings_of(building, "assumed_storey"), 2);
}

TEST(Missing, WithoutWallsStoreysAreOnSlabs) {
  Sketch sketch;
  for (const double top : {0.0, 3.5})
    sketch.element("IFCSLAB", sketch.shape(sketch.box(0, 0, top - 0.3, 6, 4, top)), "$,$");
  sketch.element("IFCCOLUMN", sketch.shape(sketch.box(2, 2, 0, 2.3, 2.3, 3.2)), "$");
  const Building building = read_sketch(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_NEAR(building.storeys[0].elevation_m, 0.0, 1e-9);
  EXPECT_NEAR(building.storeys[1].elevation_m, 3.5, 1e-9);
}

TEST(Missing, CurtainFrontsAndSlabsAreABuilding) {
  Sketch sketch = hut({.wall = ""});
  const auto front = [&](double x, double y, bool along_y, int panels) {
    const std::string whole = sketch.element("IFCCURTAINWALL", "$", "$,$");
    std::string parts;
    for (int i = 0; i < panels; ++i) {
      const std::string panel = along_y ? sketch.box(x, y + i, 0, x + 0.05, y + i + 0.95, 3)
                                        : sketch.box(x + i, y, 0, x + i + 0.95, y + 0.05, 3);
      parts += (i > 0 ? "," : "") + sketch.element("IFCPLATE", sketch.shape(panel), "$,$");
    }
    sketch.rooted("IFCRELAGGREGATES", "$,$," + whole + ",(" + parts + ")");
  };
  front(0, 0, false, 6);
  front(0, 3.95, false, 6);
  front(0, 0, true, 4);
  front(5.95, 0, true, 4);
  const Building building = read_sketch(sketch);
  EXPECT_TRUE(building.walls.empty());
  EXPECT_EQ(building.obstacles.size(), 20u);
  const auto no_walls = std::find_if(building.warnings.begin(), building.warnings.end(),
                                     [](const Warning& warning) { return warning.kind == "no_walls"; });
  ASSERT_NE(no_walls, building.warnings.end());
  EXPECT_NE(no_walls->text.find("methods that localize go by its other elements that stay where they are (20)"),
            std::string::npos)
      << no_walls->text;
  EXPECT_EQ(building.storeys.front().kind, StoreyKind::habitable);
  EXPECT_NEAR(building.storeys.front().height_m, 3.0, 1e-9);
  ASSERT_EQ(building.rooms.size(), 1u);
  EXPECT_NEAR(inner_area(building), 5.9 * 3.9, 0.3) << "bounded by the panels";
}

TEST(Missing, RoomsBetweenOpenFrontsAreSaidToBeMissing) {
  Sketch sketch = hut({.wall = ""});
  const std::string whole = sketch.element("IFCCURTAINWALL", "$", "$,$");
  const std::string panel = sketch.element("IFCPLATE", sketch.shape(sketch.box(0, 0, 0, 6, 0.05, 3)), "$,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + whole + ",(" + panel + ")");
  const Building building = read_sketch(sketch);
  EXPECT_TRUE(building.rooms.empty());
  EXPECT_EQ(warnings_of(building, "no_rooms"), 1);
}

TEST(Missing, InferredRoomsStandOnTheirFloor) {
  Sketch sketch = hut({});
  sketch.slab({{0.2, 0.2}, {5.8, 0.2}, {5.8, 3.8}, {0.2, 3.8}}, 0.0, 0.45);
  const Building building = read_sketch(sketch);
  ASSERT_EQ(building.rooms.size(), 1u);
  EXPECT_NEAR(building.rooms.front().z0_m, 0.45, 1e-9);
  EXPECT_EQ(warnings_of(building, "no_floor"), 0);
}

TEST(Missing, AStoreyWithoutPlacementIsNotSaidToLieAnywhere) {
  for (const bool placed : {false, true}) {
    Sketch sketch;
    if (placed)
      sketch.storey(0);
    else
      sketch.storey("$", "$");
    sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 37.8, 38.0);
    for (const double y : {0.0, 5.9})
      sketch.element("IFCWALL", sketch.shape(sketch.box(0, y, 38.0, 8, y + 0.1, 41.0)), "$,$");
    const Building building = read_sketch(sketch);
    ASSERT_EQ(building.storeys.size(), 1u);
    EXPECT_NEAR(building.storeys.front().elevation_m, 38.0, 1e-9);
    const auto moved = std::find_if(building.warnings.begin(), building.warnings.end(),
                                    [](const Warning& warning) { return warning.kind == "storey_moved"; });
    ASSERT_NE(moved, building.warnings.end());
    EXPECT_EQ(moved->text.find("says that it lies at 0 m") != std::string::npos, placed) << moved->text;
    EXPECT_EQ(moved->text.find("gives it no placement") != std::string::npos, !placed) << moved->text;
    EXPECT_NE(moved->text.find("at 38 m"), std::string::npos) << moved->text;
  }
}

TEST(Missing, EverythingIsRefusedWithWhatWouldBeRight) {
  Sketch nothing;
  nothing.storey(0);
  EXPECT_NE(input_error([&] { (void)read_sketch(nothing); }).find("nothing in it has a body"), std::string::npos);
  Sketch beams;
  beams.storey(0);
  beams.element("IFCBEAM", beams.shape(beams.box(0, 0, 3, 5, 0.2, 3.3)), "$,$");
  EXPECT_NE(input_error([&] { (void)read_sketch(beams); }).find("no IfcSlab, no IfcSpace and no IfcWall"),
            std::string::npos);
  Sketch door;
  door.storey(0);
  door.element("IFCDOOR", door.shape(door.box(0, 0, 0, 1, 0.1, 2)), "$,$,$,$,$,$");
  EXPECT_NE(input_error([&] { (void)read_sketch(door); }).find("no IfcWall, only 1 other element"), std::string::npos);
}

TEST(Dangling, ReferencesCostWhatDependsOnThemAndNoMore) {
  Sketch sketch = hut({});
  // A style that nothing needs, a fifth wall without a placement, an owner that is not there, and a list.
  sketch.add(
      "IFCWINDOWSTYLE('0000000000000000009001',#9999,'w',$,$,(#9998,#9997),$,$,.NOTDEFINED.,.NOTDEFINED.,.F.,.F.)");
  sketch.add("IFCWALL('0000000000000000009002',$,'w',$,$,#9996,$,$,$)");
  sketch.add("IFCOWNERHISTORY(#9995,#9994,$,.ADDED.,$,$,$,0)");
  const std::string text = sketch.text();
  const Building building = read_ifc_text(text, "s.ifc");
  EXPECT_EQ(building.walls.size(), 4u);
  EXPECT_NEAR(inner_area(building), hut_area_m2, 1e-3);
  EXPECT_EQ(warnings_of(building, "dangling"), 2);  // the wall, and that there are such references
}

// The coordinate would be read as zero, and the column would be another one.
TEST(Dangling, APointWithoutNumbersIsAsGoodAsMissing) {
  for (const std::string wrong : {"NAN", "ABC", "$", "'x'", ".T.", "1..2"}) {
    Sketch sketch = hut({});
    const std::string point = sketch.add("IFCCARTESIANPOINT((2.,2.,0.))");
    const std::string frame = sketch.add("IFCAXIS2PLACEMENT3D(" + point + ",$,$)");
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + frame + ")");
    sketch.rooted("IFCCOLUMN", "'c',$,$," + at + "," + sketch.shape(sketch.box(0, 0, 0, 1, 1, 3)) + ",$,$");
    EXPECT_EQ(read_sketch(sketch).columns.size(), 1U);
    std::string text = sketch.text();
    const std::string good = point + "=IFCCARTESIANPOINT((2.,2.";
    ASSERT_NE(text.find(good), std::string::npos) << text.substr(0, 400);
    text.replace(text.find(good) + good.size() - 2, 2, wrong);
    const Building building = read_ifc_text(text, "s.ifc");
    EXPECT_EQ(building.walls.size(), 4U) << wrong;
    EXPECT_TRUE(building.columns.empty()) << wrong;
    EXPECT_GE(warnings_of(building, "dangling"), 1) << wrong;
  }
}

TEST(Dangling, APlacementThatStandsOnNothingIsNotPutAtTheOrigin) {
  Sketch sketch = hut({});
  const std::string at = sketch.add("IFCLOCALPLACEMENT(#9999," + sketch.frame(2, 2, 0) + ")");
  const std::string lost =
      sketch.rooted("IFCCOLUMN", "'c',$,$," + at + "," + sketch.shape(sketch.box(0, 0, 0, 1, 1, 3)) + ",$,$");
  const Building building = read_sketch(sketch);
  EXPECT_TRUE(building.columns.empty()) << lost;
  EXPECT_EQ(warnings_of(building, "dangling"), 2);
}

TEST(Sense, OneElementWithoutItIsLeftOut) {
  Sketch sketch = hut({});
  // A solid without a depth; a shared GlobalId; none at all.
  sketch.element("IFCCOLUMN", sketch.shape(sketch.add("IFCEXTRUDEDAREASOLID($,$,$,$)")), "$,$");
  sketch.add("IFCWALL('0000000000000000000006',$,'again',$,$,$," + sketch.shape(sketch.box(2, 1, 0, 2.2, 3, 3)) +
             ",$,$)");
  sketch.add("IFCWALL($,$,'nobody',$,$,$," + sketch.shape(sketch.box(4, 1, 0, 4.2, 3, 3)) + ",$,$)");
  const Building building = read_sketch(sketch);
  EXPECT_EQ(building.walls.size(), 6u);
  EXPECT_EQ(warnings_of(building, "makes_no_sense"), 1);
  EXPECT_EQ(warnings_of(building, "no_global_id"), 2);
}

/// A wall of three layers as parts, which an assembly holds or nothing.
void add_layers(Sketch& sketch, double x0, double y0, double x1, double y1, bool assembled) {
  const bool along_x = x1 - x0 > y1 - y0;
  std::string parts;
  for (const auto& [low, high] : {std::pair(0.0, 0.4), std::pair(0.4, 0.6), std::pair(0.6, 1.0)}) {
    const std::string layer = along_x ? sketch.box(x0, y0 + low * (y1 - y0), 0, x1, y0 + high * (y1 - y0), 3)
                                      : sketch.box(x0 + low * (x1 - x0), y0, 0, x0 + high * (x1 - x0), y1, 3);
    parts += (parts.empty() ? "" : ",") + sketch.element("IFCBUILDINGELEMENTPART", sketch.shape(layer), "$,$");
  }
  if (!assembled) return;
  const std::string whole = sketch.element("IFCELEMENTASSEMBLY", "$", "$,.FACTORY.,.NOTDEFINED.");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + whole + ",(" + parts + ")");
}

TEST(Missing, WallsAreTakenFromLayersWithoutWall) {
  for (const bool assembled : {true, false}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.slab({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, -0.2, 0);
    add_layers(sketch, 0, 0, 6, 0.2, assembled);
    add_layers(sketch, 0, 3.8, 6, 4, assembled);
    add_layers(sketch, 0, 0.2, 0.2, 3.8, assembled);
    add_layers(sketch, 5.8, 0.2, 6, 3.8, assembled);
    const Building building = read_sketch(sketch);
    EXPECT_EQ(building.walls.size(), assembled ? 4u : 12u);
    EXPECT_TRUE(building.obstacles.empty());
    EXPECT_NEAR(inner_area(building), hut_area_m2, 1e-3);
    if (!assembled) continue;
    for (const Wall& wall : building.walls) EXPECT_NEAR(wall.thickness_m, 0.2, 1e-6);
  }
}

TEST(Missing, WallsWithoutBodyAreNotSaidToBeNone) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, -0.2, 0);
  sketch.element("IFCWALL", "$", "$,$");
  const Building building = read_sketch(sketch);
  const auto warning = std::find_if(building.warnings.begin(), building.warnings.end(),
                                    [](const Warning& w) { return w.kind == "no_walls"; });
  ASSERT_NE(warning, building.warnings.end());
  EXPECT_NE(warning->text.find("no IfcWall that can be read"), std::string::npos) << warning->text;
}

TEST(Schema, Ifc4x3ReadsWithItsNewClasses) {
  Sketch sketch = hut({.slab = "IFCBUILTELEMENT"});
  sketch.schema = "IFC4X3_ADD2";
  const std::string facility = sketch.rooted("IFCFACILITY", "'f',$,$,$,$,$,.ELEMENT.");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + sketch.project + ",(" + facility + ")");
  sketch.add("IFCTRIANGULATEDIRREGULARNETWORK($,$,$,$,$)");
  const Building building = read_sketch(sketch);
  EXPECT_EQ(building.schema, "IFC4X3_ADD2");
  EXPECT_EQ(building.slabs.size(), 1u);
  EXPECT_EQ(building.walls.size(), 4u);
  EXPECT_EQ(warnings_of(building, "other_schema"), 1);
  EXPECT_EQ(warnings_of(building, "unknown_class"), 1);
}

/// Two levels as parts of the building; one part more along it is none.
TEST(Schema, PartsOfAFacilityAreStoreysWhereTheyDivideItUpwards) {
  Sketch sketch;
  sketch.schema = "IFC4X3_ADD2";
  for (const double z : {0.0, 3.0}) {
    std::string inside;
    const auto add = [&](const std::string& id) { inside += (inside.empty() ? "" : ",") + id; };
    add(sketch.slab({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, z - 0.2, z));
    for (const double y : {0.0, 4.0})
      add(sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, y - 0.1, z, 6, y + 0.1, z + 2.8), 6), "$,$"));
    const std::string at = sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, z) + ")");
    const std::string level =
        sketch.rooted("IFCFACILITYPARTCOMMON", "'level " + std::to_string(std::lround(z)) + "',$,$," + at +
                                                   ",$,$,.ELEMENT.,.VERTICAL.,.NOTDEFINED.");
    sketch.rooted("IFCRELAGGREGATES", "$,$," + sketch.building + ",(" + level + ")");
    sketch.rooted("IFCRELCONTAINEDINSPATIALSTRUCTURE", "$,$,(" + inside + ")," + level);
  }
  const std::string side = sketch.rooted("IFCFACILITYPARTCOMMON", "'wing',$,$,$,$,$,.ELEMENT.,.LATERAL.,.SEGMENT.");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + sketch.building + ",(" + side + ")");
  const Building building = read_sketch(sketch);
  ASSERT_EQ(building.storeys.size(), 2u);
  EXPECT_EQ(building.storeys[0].name, "level 0");
  EXPECT_EQ(building.storeys[1].name, "level 3");
  EXPECT_NEAR(building.storeys[1].elevation_m, 3.0, 1e-9);
  EXPECT_EQ(warnings_of(building, "assumed_storey"), 0);
  for (const Wall& wall : building.walls) EXPECT_EQ(wall.storey, wall.z0_m > 1.0 ? 1 : 0);
}

TEST(Schema, AHeaderThatContradictsTheEntitiesIsNotBelieved) {
  Sketch sketch = hut({});
  sketch.schema = "IFC2X3";
  const Building building = read_sketch(sketch);
  EXPECT_EQ(building.walls.size(), 4u);
  EXPECT_EQ(warnings_of(building, "other_schema"), 1);
}

}  // namespace
}  // namespace plumbline::bim
