// SPDX-License-Identifier: Apache-2.0
// The same building, turned or moved far away by its site's placement, is read the same.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/mesh/mesh.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

/// The text with the site's placement replaced.
std::string with_site_at(const std::string& text, double x, double y, double turn) {
  std::smatch site, placement;
  const std::regex site_entity(R"(= ?IFCSITE\('[^']*',#\d+,(?:'[^']*'|\$),(?:'[^']*'|\$),(?:'[^']*'|\$),#(\d+))");
  if (!std::regex_search(text, site, site_entity)) return {};
  const std::string number = "#" + site[1].str();
  const std::regex local("\n" + number + " ?= ?IFCLOCALPLACEMENT\\((\\$|#\\d+),#\\d+\\);");
  if (!std::regex_search(text, placement, local)) return {};
  const auto n = [](double v) { return std::to_string(v) + (std::to_string(v).find('.') < 99 ? "" : "."); };
  const std::string frame = "\n#9900001=IFCCARTESIANPOINT((" + n(x) + "," + n(y) + ",0.));\n#9900002=IFCDIRECTION((" +
                            n(std::cos(turn)) + "," + n(std::sin(turn)) +
                            ",0.));\n#9900003=IFCAXIS2PLACEMENT3D(#9900001,$,#9900002);\n" + number +
                            "=IFCLOCALPLACEMENT(" + placement[1].str() + ",#9900003);";
  return placement.prefix().str() + frame + placement.suffix().str();
}

struct Move {
  const char* file;
  double x, y, turn;
};

void PrintTo(const Move& m, std::ostream* out) { *out << m.file; }

class TurnedTest : public testing::TestWithParam<Move> {};

TEST_P(TurnedTest, IsReadTheSame) {
  const std::string name = std::string("ifc/") + GetParam().file + ".ifc";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const std::string text = read_text_file(data_path(name));
  const std::string moved_text = with_site_at(text, GetParam().x, GetParam().y, GetParam().turn);
  ASSERT_FALSE(moved_text.empty());
  const Building still = read_ifc_text(text, "still.ifc"), moved = read_ifc_text(moved_text, "moved.ifc");
  ASSERT_EQ(still.walls.size(), moved.walls.size());
  ASSERT_EQ(still.openings.size(), moved.openings.size());
  ASSERT_EQ(still.rooms.size(), moved.rooms.size());
  for (std::size_t i = 0; i < still.rooms.size(); ++i) EXPECT_EQ(still.rooms[i].walls, moved.rooms[i].walls);
  for (std::size_t i = 0; i < still.openings.size(); ++i) {
    EXPECT_EQ(still.openings[i].rooms[0], moved.openings[i].rooms[0]) << still.openings[i].id;
    EXPECT_EQ(still.openings[i].rooms[1], moved.openings[i].rooms[1]) << still.openings[i].id;
  }
  const BuildingMesh a = build_mesh(still), b = build_mesh(moved);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    EXPECT_EQ(a.elements[i].closed, b.elements[i].closed) << a.elements[i].id;
    // Edges of cut walls lie on the 0.1 mm grid of their elevation.
    EXPECT_NEAR(a.elements[i].volume_m3, b.elements[i].volume_m3, 2e-3 * a.elements[i].volume_m3 + 1e-4)
        << a.elements[i].id;
  }
  // What far coordinates say of themselves aside, nothing new had to be given up.
  std::map<std::string, int> kinds;
  for (const Warning& warning : still.warnings) ++kinds[warning.kind];
  for (const Warning& warning : moved.warnings) --kinds[warning.kind];
  const bool far = std::abs(GetParam().x) > 1e5;
  EXPECT_EQ(kinds["recentred"], far ? -1 : 0);
  EXPECT_EQ(moved.moved_by.has_value(), far);
  for (const auto& [kind, difference] : kinds)
    EXPECT_TRUE(kind == "recentred" || difference == 0) << kind << ": " << difference;
}

INSTANTIATE_TEST_SUITE_P(Own, TurnedTest,
                         testing::Values(Move{"twin_flats", 0, 0, 0.35}, Move{"twin_flats", 512345.678, 5412345.25, 0},
                                         Move{"gable_house", 512345.678, 5412345.25, 0.35}, Move{"workshop", 0, 0, 2.2},
                                         Move{"walls_only", 0, 0, 1.1}),
                         [](const testing::TestParamInfo<Move>& info) { return "Case" + std::to_string(info.index); });
INSTANTIATE_TEST_SUITE_P(Foreign, TurnedTest,
                         testing::Values(Move{"duplex", 0, 0, 0.35}, Move{"duplex", 512345.678, 5412345.25, 0},
                                         Move{"AC20-FZK-Haus", 512345.678, 5412345.25, 0.35},
                                         Move{"LargeBuilding", 0, 0, 2.2}),
                         [](const testing::TestParamInfo<Move>& info) { return "Case" + std::to_string(info.index); });

}  // namespace
}  // namespace plumbline::bim
