// SPDX-License-Identifier: Apache-2.0
// Doors whose sides cannot be told apart say so.
#include <gtest/gtest.h>

#include <set>

#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/fixture.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

std::vector<Warning> unresolved(const Building& building) {
  std::vector<Warning> found;
  for (const Warning& warning : building.warnings)
    if (warning.kind == "door_unresolved") found.push_back(warning);
  return found;
}

/// The fixture with a space of 8 x 8 m whose lowest corner is at (x, y).
std::string with_space(const std::string& x, const std::string& y) {
  std::string text = small_ifc({});
  const std::string space =
      "#200=IFCSPACE('0000000000000000000020',$,'r',$,$,#201,#204,$,.ELEMENT.,.INTERNAL.,$);\n"
      "#201=IFCLOCALPLACEMENT(#31,#202);\n#202=IFCAXIS2PLACEMENT3D(#203,$,$);\n#203=IFCCARTESIANPOINT((" +
      x + "," + y +
      ",0.));\n#204=IFCPRODUCTDEFINITIONSHAPE($,$,(#205));\n"
      "#205=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#206));\n#206=IFCEXTRUDEDAREASOLID(#207,#11,#66,3.);\n"
      "#207=IFCRECTANGLEPROFILEDEF(.AREA.,$,#208,8.,8.);\n#208=IFCAXIS2PLACEMENT2D(#209,$);\n"
      "#209=IFCCARTESIANPOINT((4.,4.));\n#210=IFCRELAGGREGATES('0000000000000000000021',$,$,$,#30,(#200));\n";
  return text.insert(text.rfind("ENDSEC;"), space);
}

TEST(Doors, FromNowhereToNowhereIsSaid) {
  const std::vector<Warning> found = unresolved(read_ifc_text(small_ifc({}), "small.ifc"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().element, "0000000000000000000010");
  EXPECT_NE(found.front().text.find("no room"), std::string::npos);
}

TEST(Doors, WithinOneRoomIsSaid) {
  const std::vector<Warning> found = unresolved(read_ifc_text(with_space("-1.", "-2."), "small.ifc"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found.front().text.find("same room, 0000000000000000000020"), std::string::npos);
}

TEST(Doors, FromARoomToOutsideIsFine) {
  const Building building = read_ifc_text(with_space("-1.", "2.2"), "small.ifc");
  EXPECT_EQ(building.openings.front().rooms[0], 0);
  EXPECT_EQ(building.openings.front().rooms[1], -1);
  EXPECT_TRUE(unresolved(building).empty());
}

class DoorsOf : public testing::TestWithParam<const char*> {};

/// Each door of a file joins two rooms, or a room and outside, or a warning says that it does not.
TEST_P(DoorsOf, JoinRoomsOrSaySo) {
  const std::string name = std::string("ifc/") + GetParam() + ".ifc";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = read_ifc(data_path(name));
  std::size_t open_ended = 0;
  for (const Opening& opening : building.openings)
    open_ended += opening.kind == OpeningKind::door && opening.rooms[0] == opening.rooms[1] ? 1 : 0;
  EXPECT_EQ(unresolved(building).size(), open_ended);
  const std::set<std::string> with_spaces{"twin_flats", "gable_house", "workshop", "duplex", "AC20-FZK-Haus"};
  if (with_spaces.contains(GetParam())) {
    EXPECT_EQ(open_ended, 0u);
  }
  if (GetParam() == std::string("walls_only")) {
    EXPECT_EQ(open_ended, 2u + 3u + 4u);  // of the walls that stand free
  }
}

INSTANTIATE_TEST_SUITE_P(Own, DoorsOf, testing::Values("twin_flats", "gable_house", "workshop", "walls_only"),
                         [](const auto& info) { return std::string(info.param); });
INSTANTIATE_TEST_SUITE_P(Foreign, DoorsOf,
                         testing::Values("duplex", "AC20-FZK-Haus", "ManySimpleWalls", "IfcOpenHouse_IFC4"),
                         [](const auto& info) { return "Case" + std::to_string(info.index); });

}  // namespace
}  // namespace plumbline::bim
