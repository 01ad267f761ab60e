// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/ifc.h"

#include <gtest/gtest.h>

#include <clocale>
#include <fstream>
#include <iostream>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "tests/bim/formats/ifc/fixture.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

/// Without the warnings that the door leads from nowhere to nowhere and that there is no floor, as in each of these.
Building read(const SmallIfc& options) {
  Building building = read_ifc_text(small_ifc(options), "small.ifc");
  std::erase_if(building.warnings,
                [](const Warning& warning) { return warning.kind == "door_unresolved" || warning.kind == "no_floor"; });
  return building;
}

/// The wall of the fixture in W: origin (1, 2), along x, body 0.2 to the left, whatever it took to say so.
void expect_standard(const Building& building) {
  ASSERT_EQ(building.walls.size(), 1u);
  const Wall& wall = building.walls.front();
  EXPECT_NEAR((wall.a - Eigen::Vector2d(1, 2)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((wall.b - Eigen::Vector2d(5, 2)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(wall.offset_m, 0.0, 1e-9);
  EXPECT_NEAR(wall.thickness_m, 0.2, 1e-9);
  EXPECT_NEAR(wall.z0_m, 0.0, 1e-9);
  EXPECT_NEAR(wall.z1_m, 3.0, 1e-9);
  ASSERT_EQ(building.openings.size(), 1u);
  const Opening& door = building.openings.front();
  EXPECT_EQ(door.kind, OpeningKind::door);
  EXPECT_NEAR(door.s_m, 1.5, 1e-9);
  EXPECT_NEAR(door.width_m, 1.0, 1e-9);
  EXPECT_NEAR(door.z1_m, 2.0, 1e-9);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(mesh.elements.front().closed);
  EXPECT_NEAR(mesh.elements.front().volume_m3, (4.0 * 3.0 - 1.0 * 2.0) * 0.2, 1e-6);
}

TEST(Ifc, ReadsTheFixture) {
  const Building building = read({});
  expect_standard(building);
  EXPECT_EQ(building.schema, "IFC4");
  EXPECT_EQ(building.unit, "m");
  EXPECT_EQ(building.name, "small");
  EXPECT_EQ(building.walls.front().material, "brick");
  EXPECT_EQ(building.walls.front().step_id, 40);
  EXPECT_EQ(building.openings.front().filling_id, "0000000000000000000010");
  EXPECT_EQ(building.storeys.front().name, "ground");
  EXPECT_TRUE(building.warnings.empty());
}

SmallIfc drawn_in_millimetres(const std::string& unit) {
  SmallIfc mm;
  mm.unit = unit;
  mm.scale = 1000.0;
  mm.wall_location = "1000.,2000.,0.";
  mm.axis_line = "(0.,0.),(4000.,0.)";
  mm.profile_centre = "2000.,100.";
  mm.thickness = "200.";
  return mm;
}

TEST(Ifc, UnitsScaleEverything) {
  const Building building = read(drawn_in_millimetres("#3=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);"));
  EXPECT_EQ(building.unit, "mm");
  expect_standard(building);
}

TEST(Ifc, OnlyTheAssignedUnitCounts) {
  SmallIfc decoy;
  decoy.unit = "#3=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#4=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);";
  expect_standard(read(decoy));
}

TEST(Ifc, FeetAreConverted) {
  SmallIfc feet;
  feet.unit =
      "#3=IFCCONVERSIONBASEDUNIT(#4,.LENGTHUNIT.,'FOOT',#5);\n#4=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
      "#5=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#6);\n#6=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);";
  const Building building = read(feet);
  EXPECT_EQ(building.unit, "ft");
  EXPECT_NEAR(building.walls.front().length(), 4.0 * 0.3048, 1e-9);
  EXPECT_NEAR(building.walls.front().thickness_m, 0.0610, 1e-9);  // 0.06096 on the grid
}

TEST(Ifc, FileWithoutUnitIsTakenInMetresAndSaysSo) {
  SmallIfc none;
  none.unit = "#3=IFCSIUNIT(*,.TIMEUNIT.,$,.SECOND.);";
  const Building building = read(none);
  expect_standard(building);
  ASSERT_EQ(building.warnings.size(), 1u);
  EXPECT_EQ(building.warnings.front().kind, "assumed_unit");
}

TEST(Ifc, FileWithoutUnitTooLargeForMetresIsInMillimetres) {
  const Building building = read(drawn_in_millimetres("#3=IFCSIUNIT(*,.TIMEUNIT.,$,.SECOND.);"));
  EXPECT_EQ(building.unit, "mm");
  expect_standard(building);
  ASSERT_EQ(building.warnings.size(), 1u);
  EXPECT_EQ(building.warnings.front().kind, "assumed_unit");
  EXPECT_NE(building.warnings.front().text.find("4000 m large"), std::string::npos) << building.warnings.front().text;
}

/// The body lies at offset to offset + sense * thickness across the line: the reference line is not a face.
TEST(Ifc, OffsetAndSenseSayWhereTheBodyLies) {
  struct Row {
    const char *offset, *sense, *centre;
    double expected;
  };
  for (const Row& row : {Row{"0.", "POSITIVE", "2.,0.1", 0.0}, Row{"0.", "NEGATIVE", "2.,-0.1", -0.2},
                         Row{"-0.1", "POSITIVE", "2.,0.", -0.1}, Row{"0.1", "NEGATIVE", "2.,0.", -0.1},
                         Row{"0.05", "POSITIVE", "2.,0.15", 0.05}}) {
    SmallIfc options;
    options.offset = row.offset;
    options.sense = row.sense;
    options.profile_centre = row.centre;
    const Building building = read(options);
    EXPECT_NEAR(building.walls.front().offset_m, row.expected, 1e-9) << row.offset << row.sense;
    EXPECT_NEAR(building.walls.front().thickness_m, 0.2, 1e-9);
    EXPECT_TRUE(building.warnings.empty()) << row.offset << row.sense;
  }
}

TEST(Ifc, LineAgainstThePlacementTurnsTheSides) {
  SmallIfc reversed;
  reversed.axis_line = "(4.,0.),(0.,0.)";
  const Building building = read(reversed);
  const Wall& wall = building.walls.front();
  EXPECT_NEAR((wall.a - Eigen::Vector2d(5, 2)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(wall.offset_m, -0.2, 1e-9);  // the body is on the right of a to b now
  EXPECT_NEAR(building.openings.front().s_m, 2.5, 1e-9);
  EXPECT_TRUE(building.warnings.empty());
}

TEST(Ifc, LayersThatDifferFromTheBodyGiveWay) {
  SmallIfc wrong;
  wrong.thickness = "0.3";
  const Building building = read(wrong);
  EXPECT_NEAR(building.walls.front().thickness_m, 0.2, 1e-9);
  ASSERT_EQ(building.warnings.size(), 1u);
  EXPECT_EQ(building.warnings.front().kind, "layer_mismatch");
}

TEST(Ifc, WithoutLayersOrAxisTheBodyTells) {
  SmallIfc bare;
  bare.layers = false;
  bare.axis = false;
  const Building building = read(bare);
  expect_standard(building);
  ASSERT_EQ(building.warnings.size(), 2u);
  EXPECT_EQ(building.warnings[0].kind, "no_axis");
  EXPECT_EQ(building.warnings[1].kind, "no_layers");
}

/// RefDirection need not be square to Axis: its part across counts. Turned by 90 degrees about z.
TEST(Ifc, TwistedPlacementIsMadeSquare) {
  SmallIfc turned;
  turned.wall_reference = "0.,3.,5.";
  turned.wall_axis = "0.,0.,2.";
  const Building building = read(turned);
  const Wall& wall = building.walls.front();
  EXPECT_NEAR((wall.a - Eigen::Vector2d(1, 2)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((wall.b - Eigen::Vector2d(1, 6)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(wall.offset_m, 0.0, 1e-9);
  EXPECT_NEAR(build_mesh(building).elements.front().volume_m3, 2.0, 1e-6);
}

TEST(Ifc, ElevationIsThatOfThePlacement) {
  SmallIfc raised;
  raised.storey_z = "3.5";
  const Building building = read(raised);
  EXPECT_NEAR(building.storeys.front().elevation_m, 3.5, 1e-9);
  EXPECT_NEAR(building.walls.front().z0_m, 3.5, 1e-9);
  EXPECT_NEAR(building.storeys.front().height_m, 3.0, 1e-9);
}

TEST(Ifc, ObliqueWallStaysFlat) {
  SmallIfc oblique;
  oblique.wall_reference = "3.,1.,0.";
  const BuildingMesh mesh = build_mesh(read(oblique));
  EXPECT_TRUE(mesh.warnings.empty());  // taken in its elevation, not cut in 3D
  EXPECT_NEAR(mesh.elements.front().volume_m3, 2.0, 2e-3);
}

std::string message_of(const std::string& text) {
  return input_error([&] { (void)read_ifc_text(text, "small.ifc"); });
}

TEST(Ifc, BadPlacementIsNamedByItsLine) {
  SmallIfc parallel;
  parallel.wall_reference = "0.,0.,1.";
  const std::string message = message_of(small_ifc(parallel));
  EXPECT_NE(message.find("nothing in it has a body"), std::string::npos) << message;
  EXPECT_NE(message.find("small.ifc:22: #40"), std::string::npos) << message;
}

TEST(Ifc, APlacementWithoutItsRelativeOneIsNamed) {
  std::string text = small_ifc({});
  const std::string whole = "#41=IFCLOCALPLACEMENT(#31,#42)";
  text.replace(text.find(whole), whole.size(), "#41=IFCLOCALPLACEMENT(#31,$)");
  EXPECT_NE(message_of(text).find("#40: IfcWall has a placement, #41, without its RelativePlacement"),
            std::string::npos)
      << message_of(text);
}

TEST(Ifc, NothingToWalkInIsRefused) {
  std::string text = small_ifc({});
  const auto rename = [&](const std::string& from, const std::string& to) {
    std::string copy = text;
    copy.replace(copy.find(from), from.size(), to);
    return copy;
  };
  EXPECT_NE(message_of(rename("IFCWALL(", "IFCPROXX(")).find("small.ifc"), std::string::npos);
  EXPECT_NE(message_of(rename("=IFCWALL('0000000000000000000006',$,'wall',$,$,#41,#50,$,$)",
                              "=IFCFOOTING('0000000000000000000006',$,'wall',$,$,#41,#50,$,$)"))
                .find("no IfcWall"),
            std::string::npos);
}

TEST(Ifc, CutAnywhereIsAnInputError) {
  const std::string whole = small_ifc({});
  for (std::size_t length = 1; length + 1 < whole.size(); length += 37)
    EXPECT_THROW((void)read_ifc_text(whole.substr(0, length), "small.ifc"), InputError) << length;
}

/// Whatever it is, it is read or it is an InputError.
bool refused(const std::string& text) {
  try {
    (void)build_mesh(read_ifc_text(text, "small.ifc"));
    return false;
  } catch (const InputError&) {
    return true;
  }
}

TEST(Ifc, SpoiltCharactersNeverCrash) {
  const std::string whole = small_ifc({});
  const std::string bad = "$*0'(),;#.9A-\n";
  int count = 0;
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string text = whole;
    text[at] = bad[(at / 3) % bad.size()];
    count += refused(text) ? 1 : 0;
  }
  EXPECT_GT(count, 500);
}

/// Every coordinate in turn, absurd: refused or read, and meshed.
TEST(Ifc, AbsurdCoordinatesNeverCrash) {
  const std::string whole = small_ifc({});
  const std::string head = "IFCCARTESIANPOINT((";
  int tried = 0;
  for (std::size_t at = whole.find(head); at != std::string::npos; at = whole.find(head, at + 1)) {
    const std::size_t begin = at + head.size();
    for (const char* value : {"1E300", "-1E30", "1E8"}) {
      std::string text = whole;
      text.replace(begin, whole.find_first_of(",)", begin) - begin, value);
      (void)refused(text);
      ++tried;
    }
  }
  EXPECT_GE(tried, 18);
}

/// References that lead to entities of another kind, missing arguments, absurd numbers.
TEST(Ifc, SpoiltArgumentsNeverCrash) {
  const std::string whole = small_ifc({});
  const std::vector<std::string> bad = {"$",   "*",  "#3",   "#53",           "-1.", "1E300",
                                        "'x'", "()", "(#3)", "IFCLABEL('x')", ""};
  const std::string separators = "(),=";
  int count = 0, tried = 0;
  for (std::size_t begin = whole.find("DATA;") + 6; begin < whole.size();) {
    const std::size_t end = std::min(whole.find_first_of(separators + ";", begin), whole.size());
    if (end > begin && separators.find(whole[begin - 1]) != std::string::npos) {
      std::string text = whole;
      text.replace(begin, end - begin, bad[static_cast<std::size_t>(tried++) % bad.size()]);
      count += refused(text) ? 1 : 0;
    }
    begin = end + 1;
  }
  EXPECT_GT(tried, 250);
  EXPECT_GT(count, 60);  // measured: 89
}

TEST(Ifc, LeavesStreamsAndLocaleAsTheyWere) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::ostringstream out;
  std::streambuf* const old = std::cout.rdbuf(out.rdbuf());
  (void)read({});
  std::cout << "still here";
  std::cout.rdbuf(old);
  EXPECT_EQ(out.str(), "still here");
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), before);
}

TEST(Ifc, LoadBuildingKnowsIfcByItsContent) {
  const std::string path = testing::TempDir() + "plumbline_small_ifc.txt";
  std::ofstream(path) << small_ifc({});
  EXPECT_EQ(load_building(path).hash(), read({}).hash());
  std::remove(path.c_str());
  EXPECT_THROW((void)read_ifc(path), InputError);
}

TEST(Ifc, AFileCutAnywhereIsAnInputErrorWithItsLine) {
  const std::string whole = read_text_file(data_path("ifc/workshop.ifc"));
  for (const double share : {0.0003, 0.01, 0.25, 0.5, 0.75, 0.999}) {
    const std::string cut = whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
    const auto line = std::to_string(1 + std::count(cut.begin(), cut.end(), '\n'));
    const std::string message = message_of(cut);
    EXPECT_EQ(message.rfind("small.ifc:" + line + ": the file ends ", 0), 0u) << message;
  }
}

}  // namespace
}  // namespace plumbline::bim
