// SPDX-License-Identifier: Apache-2.0
// What warnings say of files by others.
#include <gtest/gtest.h>

#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

std::string text_of(const Building& building, const std::string& kind) {
  for (const Warning& warning : building.warnings)
    if (warning.kind == kind) return warning.text;
  return {};
}

TEST(Texts, AStoreyWithoutPlacementLiesAtItsElevation) {
  Sketch sketch;
  sketch.storey("$", "3.048");
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 2.8, 3.048);
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 1U);
  EXPECT_NEAR(building.storeys[0].elevation_m, 3.048, 1e-9);
  EXPECT_EQ(count(building, "storey_moved"), 0) << text_of(building, "storey_moved");
  Sketch stale;
  stale.storey("$", "3.048");
  stale.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 6.8, 7.0);
  EXPECT_NE(text_of(read(stale), "storey_moved").find("says that it lies at 3.048 m"), std::string::npos);
}

TEST(Texts, AnOpeningInNothingIsSaidToBe) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.element("IFCOPENINGELEMENT", sketch.shape(sketch.box(2, -1, 0, 3, 1, 2)), "$,$");
  const std::string said = text_of(read(sketch), "opening_unused");
  EXPECT_NE(said.find("no IfcRelVoidsElement says what it cuts"), std::string::npos) << said;
}

TEST(Texts, AnOpeningThatMissesItsWallIsNoNiche) {
  Sketch sketch;
  const std::string host = two_rooms(sketch);  // 0.3 m thick about x = 4
  sketch.door(sketch.opening(host, sketch.box(3.0, 2, 0, 3.5, 3, 2.1)));
  const Building building = read(sketch);
  EXPECT_EQ(count(building, "niche"), 0);
  const std::string said = text_of(building, "opening_unused");
  EXPECT_NE(said.find("misses its wall and cuts nothing"), std::string::npos) << said;
}

TEST(Texts, LayersOfACurvedWallAreNotComparedWithItsRectangle) {
  for (const bool curved : {false, true}) {
    Sketch sketch;
    sketch.storey(0);
    const std::string axis = sketch.add(std::string("IFCPOLYLINE((") + sketch.point(0, 0) + "," +
                                        (curved ? sketch.point(4, 1) + "," : "") + sketch.point(8, 0) + "))");
    const std::string body = sketch.prism({{0, 0}, {4, 1}, {8, 0}, {8, 0.3}, {4, 1.3}, {0, 0.3}}, 0, 3);
    const std::string context =
        sketch.add("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5," + sketch.frame(0, 0, 0) + ",$)");
    const std::string shape =
        sketch.add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
                   sketch.add("IFCSHAPEREPRESENTATION(" + context + ",'Axis','Curve2D',(" + axis + "))") + "," +
                   sketch.add("IFCSHAPEREPRESENTATION(" + context + ",'Body','SolidModel',(" + body + "))") + "))");
    const std::string wall = sketch.element("IFCWALL", shape, "$,$");
    const std::string layer = sketch.add("IFCMATERIALLAYER(" + sketch.add("IFCMATERIAL('m',$,$)") + ",0.3,$,$,$,$,$)");
    const std::string set = sketch.add("IFCMATERIALLAYERSET((" + layer + "),$,$)");
    const std::string usage = sketch.add("IFCMATERIALLAYERSETUSAGE(" + set + ",.AXIS2.,.POSITIVE.,0.,$)");
    sketch.rooted("IFCRELASSOCIATESMATERIAL", "$,$,(" + wall + ")," + usage);
    const Building building = read(sketch);
    EXPECT_EQ(count(building, "curved_axis"), curved ? 1 : 0);
    EXPECT_EQ(count(building, "layer_mismatch"), curved ? 0 : 1);
  }
}

TEST(Texts, CountAsOneDoes) {
  Sketch sketch;
  sketch.storey(0);
  sketch.element("IFCBEAM", sketch.shape(sketch.box(0, 0, 3, 5, 0.2, 3.3)), "$,$");
  const std::string said = input_error([&] { (void)read(sketch); });
  EXPECT_TRUE(said.ends_with("only 1 other element")) << said;
  Sketch rooms;
  rooms.storey(0);
  rooms.wall(0, 0, 8, 0.2, 3);
  rooms.element("IFCSPACE", rooms.shape(rooms.box(0, 0.1, 0, 8, 6, 3)), "$,.ELEMENT.,.SPACE.,$");
  rooms.add("IFCALIGNMENT('0000000000000000009001',$,'a',$,$,$,$,$)");
  rooms.add("IFCRELDEFINESBYTYPE('0000000000000000009002',$,$,$,(#9999),#9998)");
  const Building building = read(rooms);
  EXPECT_NE(text_of(building, "no_floor").find("1 of its rooms has no slab; its lower end is the floor"),
            std::string::npos)
      << text_of(building, "no_floor");
  EXPECT_NE(text_of(building, "unknown_class").find("1 of the class IFCALIGNMENT is not read"), std::string::npos)
      << text_of(building, "unknown_class");
}

TEST(Texts, ARefusalNamesAnElementBeforeAClass) {
  Sketch sketch;
  sketch.storey(0);
  sketch.add("IFCALIGNMENT('0000000000000000009001',$,'a',$,$,$,$,$)");
  const std::string empty = sketch.add("IFCEXTRUDEDAREASOLID(" + sketch.add("IFCCIRCLEPROFILEDEF(.AREA.,$,$,0.)") +
                                       ",$," + sketch.add("IFCDIRECTION((0.,0.,1.))") + ",1.)");
  sketch.element("IFCBEAM", sketch.shape(empty), "$,$");
  const std::string said = input_error([&] { (void)read(sketch); });
  EXPECT_NE(said.find("IfcBeam"), std::string::npos) << said;
}

TEST(Texts, TheHeightOfARoofIsNotMissed) {
  Sketch sketch;
  two_rooms(sketch);
  sketch.storey(3);
  sketch.slab({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 3, 3.2);
  const Building building = read(sketch);
  ASSERT_EQ(building.storeys.size(), 2U);
  EXPECT_EQ(building.storeys[1].kind, StoreyKind::roof);
  EXPECT_EQ(count(building, "assumed_height"), 0);
}

}  // namespace
}  // namespace plumbline::bim
