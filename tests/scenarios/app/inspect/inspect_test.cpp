// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/inspect/inspect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/app/inspect/inspect_symmetry.h"

namespace plumbline::scenarios {
namespace {

constexpr const char* two_rooms = R"(plan: 1
name: two rooms
storeys: [{id: ground, elevation_m: 0, height_m: 3}]
walls:
  - {id: s, storey: ground, a: [0, 0], b: [8, 0], thickness_m: 0.2}
  - {id: e, storey: ground, a: [8, 0], b: [8, 5], thickness_m: 0.2}
  - {id: n, storey: ground, a: [8, 5], b: [0, 5], thickness_m: 0.2}
  - {id: w, storey: ground, a: [0, 5], b: [0, 0], thickness_m: 0.2}
  - {id: m, storey: ground, a: [4, 0], b: [4, 5], thickness_m: 0.2}
openings:
  - {id: d1, wall: m, kind: door, s_m: 2.5, width_m: 0.9, height_m: 2.1, sill_m: 0}
  - {id: d2, wall: s, kind: door, s_m: 2.0, width_m: 0.9, height_m: 2.1, sill_m: 0}
  - {id: f1, wall: n, kind: window, s_m: 2.0, width_m: 1.2, height_m: 1.1, sill_m: 0.9}
rooms:
  - {id: west, storey: ground, polygon: [[0.1, 0.1], [3.9, 0.1], [3.9, 4.9], [0.1, 4.9]]}
  - {id: east, storey: ground, polygon: [[4.1, 0.1], [7.9, 0.1], [7.9, 4.9], [4.1, 4.9]]}
)";

class InspectTest : public testing::Test {
 protected:
  bim::Building building_ = bim::read_plan_text(two_rooms, "two.plan.yaml");
  bim::BuildingMesh mesh_ = bim::build_mesh(building_);
  Tree json_ = inspect_json(building_, mesh_);

  [[nodiscard]] const Tree& at(const char* key, std::size_t index) const {
    return json_.find(key)->as_list().at(index);
  }
};

TEST_F(InspectTest, HasTheKeysOfTheContract) {
  for (const char* key : {"hash", "schema", "unit", "storeys", "walls", "rooms", "doors", "windows", "openings",
                          "slabs", "columns", "stairs", "adjacency", "symmetry", "warnings"})
    EXPECT_NE(json_.find(key), nullptr) << key;
  for (const char* key : {"walls", "rooms", "doors", "windows", "openings"})
    for (const Tree& element : json_.find(key)->as_list())
      for (const char* field : {"id", "storey", "volume_m3", "closed", "bbox"})
        EXPECT_NE(element.find(field), nullptr) << key << " " << field;
  EXPECT_EQ(json_.find("doors")->as_list().size(), 2u);
  EXPECT_EQ(json_.find("windows")->as_list().size(), 1u);
  EXPECT_EQ(json_.find("openings")->as_list().size(), 3u);
}

TEST_F(InspectTest, WallsHaveTwoOppositeFacesOneThicknessApart) {
  for (const Tree& wall : json_.find("walls")->as_list()) {
    const auto& faces = wall.find("faces")->as_list();
    ASSERT_EQ(faces.size(), 2u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(faces[0].find("n")->as_list()[i].as_double(), -faces[1].find("n")->as_list()[i].as_double(), 1e-12);
    // Outward normals: the sum of both d is minus the thickness [shaheer2023, eq. 2, corrected].
    EXPECT_NEAR(faces[0].find("d")->as_double() + faces[1].find("d")->as_double(), -0.2, 1e-9);
  }
}

TEST_F(InspectTest, WallVolumeIsThatOfTheCutSolid) {
  // m: 5 m long, 3 m high, 0.2 m thick, one door.
  for (const Tree& wall : json_.find("walls")->as_list()) {
    if (wall.find("id")->as_string() != "m") continue;
    EXPECT_NEAR(wall.find("volume_m3")->as_double(), (5.0 * 3.0 - 0.9 * 2.1) * 0.2, 1e-6);
  }
}

TEST_F(InspectTest, RoomsHaveAreaFacesAndNeighbours) {
  EXPECT_NEAR(at("rooms", 0).find("area_m2")->as_double(), 3.8 * 4.8, 1e-9);
  EXPECT_EQ(at("rooms", 0).find("faces")->as_list().size(), 4u);
  const auto& adjacency = json_.find("adjacency")->as_list();
  ASSERT_EQ(adjacency.size(), 3u);  // both doors and the window
  int outside = 0;
  for (const Tree& pair : adjacency)
    for (const Tree& room : pair.find("rooms")->as_list()) outside += room.is_null() ? 1 : 0;
  EXPECT_EQ(outside, 2);
}

TEST_F(InspectTest, JsonIsTheSameTwice) { EXPECT_EQ(write_json(json_), write_json(inspect_json(building_, mesh_))); }

TEST_F(InspectTest, TextNamesStoreysRoomsAndTotals) {
  const std::string text = inspect_text(building_, mesh_, {});
  for (const char* part : {"ground", "west", "east", "outside", "18.2", "5 walls", "no warnings"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST_F(InspectTest, TextGroupsWarningsByKind) {
  building_.warnings = {{"a", "no_layers", "first"}, {"b", "no_layers", "second"}, {"", "assumed_unit", "metres"}};
  const std::string text = inspect_text(building_, mesh_, {});
  EXPECT_NE(text.find("a: first"), std::string::npos);
  EXPECT_EQ(text.find("second"), std::string::npos);
  EXPECT_NE(text.find("assumed_unit"), std::string::npos);
}

TEST_F(InspectTest, TextListsSolidsByKindAndWhatIsNotAsPlanned) {
  const std::string planned = inspect_text(building_, mesh_, {});
  EXPECT_NE(planned.find("wall        5       5"), std::string::npos) << planned;
  EXPECT_EQ(planned.find("not as planned"), std::string::npos);
  const std::string built = inspect_text(building_, mesh_, {{"move_wall", "w1"}, {"drop_room", "west"}});
  EXPECT_NE(built.find("not as planned  element"), std::string::npos) << built;
  EXPECT_NE(built.find("move_wall       w1"), std::string::npos) << built;
}

/// Walls along a regular polygon around (0, 0).
bim::Building polygon_hall(int corners) {
  std::string text = "plan: 1\nname: hall\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\nwalls:\n";
  std::string room;
  const auto corner = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    return "[" + format_number(8.0 * std::cos(angle)) + ", " + format_number(8.0 * std::sin(angle)) + "]";
  };
  for (int i = 0; i < corners; ++i) {
    text += "  - {id: w" + std::to_string(i) + ", storey: g, a: " + corner(i) + ", b: " + corner(i + 1) + "}\n";
    room += (i == 0 ? "" : ", ") + corner(i);
  }
  return bim::read_plan_text(text + "rooms: [{id: r, storey: g, polygon: [" + room + "]}]\n", "hall.plan.yaml");
}

int lines_with(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(InspectSymmetry, ManyTurnsAboutOnePointAreOneLine) {
  const bim::Building building = polygon_hall(24);
  const bim::SymmetryReport report = bim::analyse_symmetry(building);
  ASSERT_EQ(report.building.size(), 23U);
  const std::string text = symmetry_text(building, report);
  EXPECT_EQ(lines_with(text, "whole building: 24-fold about (0.00, 0.00), turns by multiples of 15.00 deg"), 1) << text;
  EXPECT_EQ(lines_with(text, "\n  whole building"), 1) << text;
  EXPECT_EQ(lines_with(text, "mirror image at"), 3) << text;
  EXPECT_EQ(lines_with(text, "21 more mirror images (--json lists them)"), 1) << text;
}

TEST(InspectSymmetry, TurnsThatFormNoGroupAreCounted) {
  const bim::Building building = polygon_hall(24);
  bim::SymmetryReport report = bim::analyse_symmetry(building);
  report.building.erase(report.building.begin() + 7);
  const std::string text = symmetry_text(building, report);
  EXPECT_EQ(lines_with(text, "whole building: turn by"), 3) << text;
  EXPECT_EQ(lines_with(text, "whole building: 19 more motions (--json lists them)"), 1) << text;
}

TEST(InspectSymmetry, FewTurnsAreListed) {
  const bim::Building building = polygon_hall(4);
  const std::string text = symmetry_text(building, bim::analyse_symmetry(building));
  EXPECT_EQ(lines_with(text, "whole building: turn by"), 3) << text;
  EXPECT_EQ(lines_with(text, "mirror image at"), 4) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
