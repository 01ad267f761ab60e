// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/traffic_editor/traffic_editor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

/// 10 px a metre, y down: two rooms of 4 m x 5 m side by side with a door between them in a gap of the middle wall, a
/// doorway left open in the south wall, and an outer door drawn within the west wall.
std::string two_rooms() {
  return R"(name: two
coordinate_system: reference_image
lifts: {lift: {x: 0}}
levels:
  L1:
    elevation: 1
    drawing: {filename: two.png}
    vertices:
      - [100, 100, 0, ""]
      - [140, 100, 0, ""]
      - [180, 100, 0, ""]
      - [100, 150, 0, ""]
      - [140, 150, 0, ""]
      - [180, 150, 0, ""]
      - [140, 120, 0, ""]
      - [140, 129, 0, ""]
      - [160, 150, 0, ""]
      - [168, 150, 0, ""]
      - [100, 120, 0, ""]
      - [100, 129, 0, ""]
      - [120, 110, 0, kitchen]
    measurements:
      - [0, 2, {distance: [3, 8]}]
    walls:
      - [0, 1, {alpha: [3, 1]}]
      - [1, 2, {}]
      - [0, 3, {}]
      - [3, 4, {}]
      - [4, 8, {}]
      - [9, 5, {}]
      - [2, 5, {}]
      - [1, 6, {}]
      - [7, 4, {}]
    doors:
      - [6, 7, {name: [1, inner], type: [1, hinged]}]
      - [10, 11, {name: [1, outer], type: [1, hinged]}]
    floors:
      - {parameters: {}, vertices: [0, 2, 5, 3]}
    models: [{name: chair, x: 1, y: 2}]
)";
}

Building read(const std::string& text) { return read_traffic_editor_text(text, "two.building.yaml"); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::size_t count(const Building& building, OpeningKind kind) {
  return static_cast<std::size_t>(std::count_if(building.openings.begin(), building.openings.end(),
                                                [&](const Opening& o) { return o.kind == kind; }));
}

std::size_t warnings(const Building& building, const std::string& kind) {
  return static_cast<std::size_t>(std::count_if(building.warnings.begin(), building.warnings.end(),
                                                [&](const Warning& w) { return w.kind == kind; }));
}

TEST(TrafficEditor, ReadsWallsDoorsFloorsAndRooms) {
  const Building building = read(two_rooms());
  EXPECT_EQ(building.schema, "traffic_editor");
  ASSERT_EQ(building.storeys.size(), 1u);
  EXPECT_EQ(building.storeys[0].elevation_m, 1.0);
  // Nine walls, and one over each of the two gaps.
  EXPECT_EQ(building.walls.size(), 11u);
  EXPECT_EQ(count(building, OpeningKind::door), 2u);
  EXPECT_EQ(count(building, OpeningKind::opening_void), 1u);
  EXPECT_EQ(warnings(building, "assumed_doorway"), 1u);
  EXPECT_EQ(warnings(building, "left_out"), 2u);
  // y is up: the drawing's upper edge at 100 px is y = -10 m.
  EXPECT_EQ(building.walls[0].name, "L1/wall0");
  EXPECT_NEAR(building.walls[0].a.y(), -10.0, 1e-9);
  ASSERT_EQ(building.rooms.size(), 2u);
  for (const Room& room : building.rooms) EXPECT_NEAR(signed_area(room.polygon), 3.9 * 4.9, 1e-6) << room.id;
  EXPECT_TRUE(building.rooms[0].name == "kitchen" || building.rooms[1].name == "kitchen");
  const BuildingMesh mesh = build_mesh(building);
  for (const MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << element.id;
}

TEST(TrafficEditor, DoorsJoinTheRoomsOnTheirSides) {
  const Building building = read(two_rooms());
  for (const Opening& opening : building.openings) {
    const std::set<int> sides = {opening.rooms[0], opening.rooms[1]};
    if (opening.id == "L1/inner")
      EXPECT_EQ(sides, (std::set<int>{0, 1}));
    else
      EXPECT_EQ(sides.size() + sides.count(-1), 3u) << opening.id;
  }
  const auto outer = std::find_if(building.openings.begin(), building.openings.end(),
                                  [](const Opening& o) { return o.id == "L1/outer"; });
  ASSERT_NE(outer, building.openings.end());
  EXPECT_EQ(building.walls[static_cast<std::size_t>(outer->wall)].id, "L1/wall2");
  EXPECT_NEAR(outer->width_m, 0.9, 1e-9);
}

/// A wall with no more than pen slips in it, and edges shorter than the closing distance, still encloses a room.
TEST(TrafficEditor, ShortEdgesDoNotOpenARoom) {
  std::string text =
      replaced(two_rooms(), "      - [0, 3, {}]\n", "      - [0, 13, {}]\n      - [13, 14, {}]\n      - [14, 3, {}]\n");
  text = replaced(text, "      - [120, 110, 0, kitchen]\n",
                  "      - [120, 110, 0, kitchen]\n      - [100.2, 140, 0, \"\"]\n      - [99.7, 140.3, 0, \"\"]\n");
  text = replaced(text, "[10, 11, {name: [1, outer]", "[6, 7, {name: [1, outer]");
  EXPECT_EQ(read(text).rooms.size(), 2u);
}

/// A door over the vertex between two walls in line, in the middle of both and nearly all in one.
TEST(TrafficEditor, ADoorOverTheVertexOfTwoWallsKeepsItsWidth) {
  for (const double vertex : {120.0, 124.0, 128.0}) {
    std::string text = replaced(two_rooms(), "- [1, 6, {}]\n      - [7, 4, {}]", "- [1, 13, {}]\n      - [13, 4, {}]");
    text = replaced(text, "      - [120, 110, 0, kitchen]\n",
                    "      - [120, 110, 0, kitchen]\n      - [140, " + std::to_string(vertex) + ", 0, \"\"]\n");
    const Building building = read(text);
    double width = 0.0;
    for (const Opening& opening : building.openings)
      if (opening.id.starts_with("L1/inner")) {
        width += opening.width_m;
        EXPECT_EQ((std::set<int>{opening.rooms[0], opening.rooms[1]}), (std::set<int>{0, 1})) << opening.id;
      }
    EXPECT_NEAR(width, 0.9, 1e-9) << vertex;
    for (const MeshElement& element : build_mesh(building).elements) EXPECT_TRUE(element.closed) << element.id;
  }
}

/// One that reaches beyond the end of its wall is narrower than drawn.
TEST(TrafficEditor, ANarrowedDoorIsSaid) {
  const std::string text = replaced(two_rooms(), "- [100, 120, 0, \"\"]", "- [100, 96, 0, \"\"]");
  const std::string narrowed = replaced(text, "- [100, 129, 0, \"\"]", "- [100, 109, 0, \"\"]");
  const Building building = read(narrowed);
  EXPECT_EQ(warnings(building, "left_out"), warnings(read(two_rooms()), "left_out") + 1);
}

TEST(TrafficEditor, MetresNeedNoMeasurement) {
  std::string text = replaced(two_rooms(), "reference_image", "cartesian_meters");
  text = replaced(text, "      - [0, 2, {distance: [3, 8]}]", "      []");
  EXPECT_NEAR(read(text).walls[0].a.y(), 100.0, 1e-9);
}

TEST(TrafficEditor, BadInputIsNamed) {
  const std::string good = two_rooms();
  const std::pair<std::string, std::string> spoilt[] = {
      {"[0, 2, {distance: [3, 8]}]", "[0, 2, {distance: [3, -8]}]"},
      {"[0, 2, {distance: [3, 8]}]", "[0, 0, {distance: [3, 8]}]"},
      {"      - [0, 2, {distance: [3, 8]}]", "      []"},
      {"[0, 1, {alpha: [3, 1]}]", "[0, 99, {}]"},
      {"[0, 1, {alpha: [3, 1]}]", "[0, -1, {}]"},
      {"[0, 1, {alpha: [3, 1]}]", "[0]"},
      {"[100, 100, 0, \"\"]", "[1e300, 100, 0, \"\"]"},
      {"[100, 100, 0, \"\"]", "[.nan, 100, 0, \"\"]"},
      {"[100, 100, 0, \"\"]", "[.inf, 100, 0, \"\"]"},
      {"elevation: 1", "elevation: [1]"},
      {"elevation: 1", "elevation: 1e30"},
      {"vertices: [0, 2, 5, 3]", "vertices: [0, 2, 5, 300]"},
      {"reference_image", "wgs84"},
      {"levels:\n  L1:", "levels: 3\nL1:"},
  };
  for (const auto& [from, to] : spoilt) EXPECT_THROW((void)read(replaced(good, from, to)), InputError) << to;
}

TEST(TrafficEditor, CutAnywhereIsReadOrRefused) {
  const std::string whole = two_rooms();
  for (std::size_t i = 0; i < 200; ++i) {
    try {
      (void)build_mesh(read(whole.substr(0, i * whole.size() / 200)));
    } catch (const InputError&) {
    }
  }
}

class TrafficEditorPlans : public testing::TestWithParam<std::string> {};

/// Counts derived from the file itself: every wall and door is there.
TEST_P(TrafficEditorPlans, HaveEveryWallAndDoor) {
  const std::string name = "plans/" + GetParam() + ".building.yaml", path = data_path(name);
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = load_building(path);
  const Tree file = read_yaml(read_text_file(path), path);
  for (const auto& entry : file.find("levels")->as_map()) {
    const std::string& level = entry.first;
    const Tree& tree = entry.second;
    const auto of_level = [&](const auto& list, const std::string& part) {
      return std::count_if(list.begin(), list.end(),
                           [&](const auto& item) { return item.id.starts_with(level + "/" + part); });
    };
    EXPECT_EQ(of_level(building.walls, "wall"), static_cast<std::ptrdiff_t>(tree.find("walls")->as_list().size()));
    const auto doors = std::count_if(building.openings.begin(), building.openings.end(), [&](const Opening& o) {
      return o.kind == OpeningKind::door &&
             building.storeys[static_cast<std::size_t>(building.walls[static_cast<std::size_t>(o.wall)].storey)].id ==
                 level;
    });
    EXPECT_EQ(doors, static_cast<std::ptrdiff_t>(tree.find("doors")->as_list().size())) << level;
  }
  for (const MeshElement& element : build_mesh(building).elements) EXPECT_TRUE(element.closed) << element.id;
}

INSTANTIATE_TEST_SUITE_P(Own, TrafficEditorPlans, testing::Values("guesthouse"),
                         [](const auto& info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Foreign, TrafficEditorPlans, testing::Values("office", "hotel"),
                         [](const auto& info) { return info.param; });

/// A plan whose two upper floors are the same, each with so many rooms.
struct RepeatedFloor {
  std::string plan;
  std::ptrdiff_t rooms;
};

void PrintTo(const RepeatedFloor& c, std::ostream* out) { *out << c.plan; }

class TrafficEditorFloors : public testing::TestWithParam<RepeatedFloor> {};

TEST_P(TrafficEditorFloors, AreRepeated) {
  const std::string name = "plans/" + GetParam().plan + ".building.yaml";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = load_building(data_path(name));
  ASSERT_EQ(building.storeys.size(), 3u);
  std::vector<Wall> upper[2];
  for (const Wall& wall : building.walls)
    if (wall.storey > 0) upper[wall.storey - 1].push_back(wall);
  ASSERT_EQ(upper[0].size(), upper[1].size());
  for (std::size_t i = 0; i < upper[0].size(); ++i) EXPECT_LT((upper[0][i].a - upper[1][i].a).norm(), 1e-9);
  EXPECT_EQ(std::count_if(building.rooms.begin(), building.rooms.end(), [](const Room& r) { return r.storey == 1; }),
            GetParam().rooms);
}

// As counted on the drawings: so many of the enclosed regions have a floor; lift, shaft and stairs have none.
INSTANTIATE_TEST_SUITE_P(Own, TrafficEditorFloors, testing::Values(RepeatedFloor{"guesthouse", 5}),
                         [](const auto& info) { return info.param.plan; });
INSTANTIATE_TEST_SUITE_P(Foreign, TrafficEditorFloors, testing::Values(RepeatedFloor{"hotel", 22}),
                         [](const auto& info) { return info.param.plan; });

}  // namespace
}  // namespace plumbline::bim
