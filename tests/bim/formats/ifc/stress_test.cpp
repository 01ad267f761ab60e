// SPDX-License-Identifier: Apache-2.0
// A building of 544 walls and 256 spaces, in metres, millimetres and feet.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <sstream>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/mesh.h"
#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

constexpr int cells = 16;  // along each side
constexpr std::size_t wall_count = 2 * cells * (cells + 1), room_count = cells * cells;

/// Cells of 6 x 4 m, a door and a window in each wall between two corners.
std::string lattice() {
  std::ostringstream walls, openings, rooms;
  int count = 0;
  const auto add_wall = [&](int x0, int y0, int x1, int y1) {
    const std::string id = "w" + std::to_string(count++);
    walls << "  - {id: " << id << ", storey: s, a: [" << 6 * x0 << ", " << 4 * y0 << "], b: [" << 6 * x1 << ", "
          << 4 * y1 << "], thickness_m: 0.2}\n";
    openings << "  - {id: " << id << "d, wall: " << id << ", kind: door, s_m: 1, width_m: 0.9}\n  - {id: " << id
             << "v, wall: " << id << ", kind: window, s_m: 2.6, width_m: 1.2, sill_m: 0.9, height_m: 1.2}\n";
  };
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      add_wall(i, j, i, j + 1);
      add_wall(j, i, j + 1, i);
      if (i == cells) continue;
      rooms << "  - {id: r" << i << "_" << j << ", storey: s, polygon: [[" << 6 * i << ", " << 4 * j << "], ["
            << 6 * (i + 1) << ", " << 4 * j << "], [" << 6 * (i + 1) << ", " << 4 * (j + 1) << "], [" << 6 * i << ", "
            << 4 * (j + 1) << "]]}\n";
    }
  }
  return "plan: 1\nname: lattice\nstoreys: [{id: s}]\nwalls:\n" + walls.str() + "openings:\n" + openings.str() +
         "rooms:\n" + rooms.str();
}

/// The line with its lengths multiplied; they are the numbers with a decimal point in entities that hold no others.
std::string scaled_line(const std::string& line, double factor) {
  constexpr std::array<const char*, 4> of_lengths = {"=IFCCARTESIANPOINT(", "=IFCEXTRUDEDAREASOLID(",
                                                     "=IFCMATERIALLAYER(", "=IFCMATERIALLAYERSETUSAGE("};
  if (std::none_of(of_lengths.begin(), of_lengths.end(),
                   [&](const char* type) { return line.find(type) != std::string::npos; }))
    return line;
  std::string result;
  for (std::size_t at = 0; at < line.size();) {
    char* end = nullptr;
    const bool begins = at > 0 && (line[at - 1] == '(' || line[at - 1] == ',') &&
                        (std::isdigit(static_cast<unsigned char>(line[at])) != 0 || line[at] == '-');
    const double value = begins ? std::strtod(line.c_str() + at, &end) : 0.0;
    if (!begins) {
      result += line[at++];
      continue;
    }
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.12f", value * factor);
    result += text.data();
    at = static_cast<std::size_t>(end - line.c_str());
  }
  return result;
}

/// The lattice as IFC in a unit. It bears no valid mark, so it is read like any other.
std::string lattice_ifc(const std::string& unit, double unit_m) {
  std::istringstream lines(write_ifc(read_plan_text(lattice(), "lattice.yaml")));
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const bool length = line.find(".LENGTHUNIT.") != std::string::npos;
    const std::string number = line.substr(0, line.find('='));
    result += (length ? number + unit : scaled_line(line, 1.0 / unit_m)) + "\n";
  }
  return result;
}

const std::string metres = "=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.); ";
const std::string millimetres = "=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);";
const std::string feet =
    "=IFCCONVERSIONBASEDUNIT(#900001,.LENGTHUNIT.,'FOOT',#900002);\n#900001=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
    "#900002=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#900003);\n#900003=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);";

Building lattice_in(const std::string& unit, double unit_m) {
  const std::string text = lattice_ifc(unit, unit_m);
  EXPECT_FALSE(has_roundtrip_signature(text));
  return read_ifc_text(text, "lattice.ifc");
}

TEST(Stress, HundredsOfWallsAndRoomsAreReadWholeAndInTime) {
  const std::string text = lattice_ifc(metres, 1.0);
  ASSERT_FALSE(has_roundtrip_signature(text));
  const std::clock_t begin = std::clock();
  const Building building = read_ifc_text(text, "lattice.ifc");
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 10.0 * slower);  // CPU time, with the mesh
  EXPECT_EQ(building.walls.size(), wall_count);
  EXPECT_EQ(building.openings.size(), 2 * wall_count);
  EXPECT_EQ(building.rooms.size(), room_count);
  EXPECT_EQ(building.slabs.size(), 2u);
  for (const MeshElement& element : mesh.elements) EXPECT_TRUE(element.closed) << element.id;
  for (const Room& room : building.rooms) EXPECT_EQ(room.walls.size(), 4u) << room.name;
  EXPECT_TRUE(building.warnings.empty()) << building.warnings.front().kind;
  double volume_m3 = 0.0;
  for (std::size_t i = 0; i < building.walls.size(); ++i) volume_m3 += mesh.elements[i].volume_m3;
  // 272 walls of either length, 3 m high; a door of 0.9 x 2.1 and a window of 1.2 x 1.2 in each.
  EXPECT_NEAR(volume_m3, 0.2 * (272.0 * (6.0 + 4.0) * 3.0 - 544.0 * (0.9 * 2.1 + 1.2 * 1.2)), 1e-3);
}

void expect_same_walls(const Building& a, const Building& b) {
  constexpr double near_m = 1e-6;
  ASSERT_EQ(a.walls.size(), b.walls.size());
  for (std::size_t i = 0; i < a.walls.size(); ++i) {
    const Wall &v = a.walls[i], &w = b.walls[i];
    EXPECT_EQ(v.id, w.id);
    EXPECT_LT((v.a - w.a).norm() + (v.b - w.b).norm(), near_m) << v.id;
    EXPECT_NEAR(v.offset_m, w.offset_m, near_m);
    EXPECT_NEAR(v.thickness_m, w.thickness_m, near_m);
    EXPECT_NEAR(v.z0_m, w.z0_m, near_m);
    EXPECT_NEAR(v.z1_m, w.z1_m, near_m);
  }
}

void expect_same(const Building& a, const Building& b) {
  constexpr double near_m = 1e-6;
  expect_same_walls(a, b);
  ASSERT_EQ(a.openings.size(), b.openings.size());
  for (std::size_t i = 0; i < a.openings.size(); ++i) {
    const Opening &p = a.openings[i], &q = b.openings[i];
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.wall, q.wall);
    EXPECT_NEAR(p.s_m, q.s_m, near_m);
    EXPECT_NEAR(p.width_m, q.width_m, near_m);
    EXPECT_NEAR(p.z0_m, q.z0_m, near_m);
    EXPECT_NEAR(p.z1_m, q.z1_m, near_m);
    EXPECT_EQ(p.rooms[0], q.rooms[0]);
    EXPECT_EQ(p.rooms[1], q.rooms[1]);
  }
  ASSERT_EQ(a.rooms.size(), b.rooms.size());
  for (std::size_t i = 0; i < a.rooms.size(); ++i) {
    ASSERT_EQ(a.rooms[i].polygon.size(), b.rooms[i].polygon.size());
    for (std::size_t k = 0; k < a.rooms[i].polygon.size(); ++k)
      EXPECT_LT((a.rooms[i].polygon[k] - b.rooms[i].polygon[k]).norm(), near_m) << a.rooms[i].name;
    EXPECT_EQ(a.rooms[i].walls, b.rooms[i].walls);
  }
}

TEST(Stress, IsTheSameInMillimetresAndFeet) {
  const Building in_m = lattice_in(metres, 1.0);
  const Building in_mm = lattice_in(millimetres, 1e-3), in_ft = lattice_in(feet, 0.3048);
  EXPECT_EQ(in_mm.unit, "mm");
  EXPECT_EQ(in_ft.unit, "ft");
  expect_same(in_m, in_mm);
  expect_same(in_m, in_ft);
}

}  // namespace
}  // namespace plumbline::bim
