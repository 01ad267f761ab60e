// SPDX-License-Identifier: Apache-2.0
// Rooms of files: their walls against the relation that some of the files have, and the rooms at their doors.
#include "bim/model/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/read_ifc.h"
#include "tests/data.h"
#include "tests/test_name.h"

namespace plumbline::bim {
namespace {

using Pairs = std::set<std::pair<std::int64_t, std::int64_t>>;

/// (space, wall) by STEP number of every IfcRelSpaceBoundary to a wall, found in the text.
Pairs stated_boundaries(const std::string& path, const Building& building) {
  std::set<std::int64_t> walls;
  for (const Wall& wall : building.walls) walls.insert(wall.step_id);
  const std::string text = read_text_file(path);
  const std::regex relation(R"(IFCRELSPACEBOUNDARY\('[^']*',#\d+,(?:'[^']*'|\$),(?:'[^']*'|\$),#(\d+),#(\d+))");
  Pairs pairs;
  for (std::size_t at = text.find("IFCRELSPACEBOUNDARY("); at != std::string::npos;
       at = text.find("IFCRELSPACEBOUNDARY(", at + 1)) {
    std::string statement = text.substr(at, text.find(';', at) - at);
    std::erase_if(statement, [](char c) { return c == '\n' || c == '\r'; });
    std::smatch match;
    if (!std::regex_search(statement, match, relation)) continue;
    const std::int64_t wall = std::stoll(match[2]);
    if (walls.contains(wall)) pairs.emplace(std::stoll(match[1]), wall);
  }
  return pairs;
}

Pairs found_boundaries(const Building& building) {
  Pairs pairs;
  for (const Room& room : building.rooms)
    for (const int wall : room.walls)
      pairs.emplace(room.step_id, building.walls[static_cast<std::size_t>(wall)].step_id);
  return pairs;
}

/// Whether a file says which walls bound its rooms.
enum class StatedBounds { none, stated };

struct RoomsFile {
  const char* name;
  StatedBounds bounds;
};

void PrintTo(const RoomsFile& file, std::ostream* out) { *out << file.name; }

class RoomsOf : public testing::TestWithParam<RoomsFile> {
 protected:
  void SetUp() override {
    const std::string name = std::string("ifc/") + GetParam().name + ".ifc";
    if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
    path_ = data_path(name);
    building_ = read_ifc(path_);
  }
  void bounding_walls_are_those_the_file_states();
  void doors_lead_somewhere_and_rooms_can_be_left();
  void virtual_edges_lie_on_the_outline_and_not_on_walls();

  std::string path_;
  Building building_;
};

void RoomsOf::bounding_walls_are_those_the_file_states() {
  const Pairs stated = stated_boundaries(path_, building_), found = found_boundaries(building_);
  EXPECT_EQ(stated.empty(), GetParam().bounds == StatedBounds::none);
  if (stated.empty()) return;
  Pairs both;
  std::set_intersection(stated.begin(), stated.end(), found.begin(), found.end(), std::inserter(both, both.end()));
  EXPECT_EQ(both.size(), stated.size());  // recall 1
  EXPECT_GE(static_cast<double>(both.size()), 0.97 * static_cast<double>(found.size()));
}

/// Every door leads from one room to another or to the outside, and every room can be left.
void RoomsOf::doors_lead_somewhere_and_rooms_can_be_left() {
  std::set<int> left;
  for (const Adjacent& pair : adjacency(building_))
    if (pair.by != Passage::window) left.insert({pair.a, pair.b});
  for (const Opening& opening : building_.openings) {
    if (opening.kind == OpeningKind::door) {
      EXPECT_NE(opening.rooms[0], opening.rooms[1]) << opening.id;
    }
  }
  for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
    const Room& room = building_.rooms[i];
    const bool walkable = building_.storeys[static_cast<std::size_t>(room.storey)].kind == StoreyKind::habitable;
    EXPECT_TRUE(!walkable || left.contains(static_cast<int>(i))) << room.name;
  }
}

/// A stretch without a wall is not also one along a wall: together they are no longer than the outline.
void RoomsOf::virtual_edges_lie_on_the_outline_and_not_on_walls() {
  for (const Room& room : building_.rooms) {
    double open = 0.0, along = 0.0, outline = 0.0;
    for (const VirtualEdge& edge : room.virtual_edges) {
      open += (edge.b - edge.a).norm();
      EXPECT_LT(boundary_distance(room.polygon, 0.5 * (edge.a + edge.b)), 1e-6) << room.name;
    }
    for (const int wall : room.walls)
      for (const int side : {0, 1}) along += shared_length(room, building_.walls[static_cast<std::size_t>(wall)], side);
    for (std::size_t i = 0; i < room.polygon.size(); ++i)
      outline += (room.polygon[(i + 1) % room.polygon.size()] - room.polygon[i]).norm();
    EXPECT_LE(open + along, outline + 0.5) << room.name;  // wall ends overlap in corners by up to a gap each
  }
}

TEST_P(RoomsOf, AreBoundedAndCanBeLeft) {
  bounding_walls_are_those_the_file_states();
  doors_lead_somewhere_and_rooms_can_be_left();
  virtual_edges_lie_on_the_outline_and_not_on_walls();
}

std::string rooms_name(const testing::TestParamInfo<RoomsFile>& info) { return test_name(info.param.name); }

INSTANTIATE_TEST_SUITE_P(Own, RoomsOf,
                         testing::Values(RoomsFile{"twin_flats", StatedBounds::stated},
                                         RoomsFile{"gable_house", StatedBounds::stated},
                                         RoomsFile{"workshop", StatedBounds::none}),
                         rooms_name);
INSTANTIATE_TEST_SUITE_P(Foreign, RoomsOf,
                         testing::Values(RoomsFile{"duplex", StatedBounds::stated},
                                         RoomsFile{"AC20-FZK-Haus", StatedBounds::stated},
                                         RoomsFile{"LargeBuilding", StatedBounds::none}),
                         rooms_name);

/// Two flats with a stair each.
struct JoinedFlats {
  const char* file;
  int doors;
};

void PrintTo(const JoinedFlats& c, std::ostream* out) { *out << c.file; }

class AdjacencyOfFlats : public testing::TestWithParam<JoinedFlats> {};

TEST_P(AdjacencyOfFlats, StairsJoinTheLevels) {
  const std::string name = std::string("ifc/") + GetParam().file + ".ifc";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = read_ifc(data_path(name));
  std::map<Passage, int> count;
  std::set<std::pair<std::string, std::string>> stairs;
  for (const Adjacent& pair : adjacency(building)) {
    ++count[pair.by];
    if (pair.by == Passage::stair)
      stairs.insert(std::minmax(building.rooms[static_cast<std::size_t>(pair.a)].name,
                                building.rooms[static_cast<std::size_t>(pair.b)].name));
  }
  EXPECT_EQ(count[Passage::door], GetParam().doors);
  EXPECT_EQ(stairs, (std::set<std::pair<std::string, std::string>>{{"Foyer A101", "Hallway A201"},
                                                                   {"Foyer B101", "Hallway B201"}}));
}

INSTANTIATE_TEST_SUITE_P(Own, AdjacencyOfFlats, testing::Values(JoinedFlats{"twin_flats", 6}),
                         [](const auto& info) { return std::string(info.param.file); });
INSTANTIATE_TEST_SUITE_P(Foreign, AdjacencyOfFlats, testing::Values(JoinedFlats{"duplex", 14}),
                         [](const auto& info) { return std::string(info.param.file); });

}  // namespace
}  // namespace plumbline::bim
