// SPDX-License-Identifier: Apache-2.0
// Rooms of real files: their walls against the relation that two of the files have, and the rooms at their doors.
#include "bim/model/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/model/adjacency.h"
#include "tests/bim/formats/ifc/data.h"

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

class RealRooms : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    path_ = data_path(std::string("ifc/") + GetParam() + ".ifc");
    if (!std::filesystem::exists(path_)) GTEST_SKIP() << "no test data at " << path_;
    building_ = read_ifc(path_);
  }
  std::string path_;
  Building building_;
};

TEST_P(RealRooms, BoundingWallsAreThoseTheFileStates) {
  const Pairs stated = stated_boundaries(path_, building_), found = found_boundaries(building_);
  if (stated.empty()) GTEST_SKIP() << "the file states no boundaries";
  Pairs both;
  std::set_intersection(stated.begin(), stated.end(), found.begin(), found.end(), std::inserter(both, both.end()));
  EXPECT_EQ(both.size(), stated.size());  // recall 1
  EXPECT_GE(static_cast<double>(both.size()), 0.97 * static_cast<double>(found.size()));
}

/// Every door leads from one room to another or to the outside, and every room can be left.
TEST_P(RealRooms, DoorsLeadSomewhereAndRoomsCanBeLeft) {
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
TEST_P(RealRooms, VirtualEdgesLieOnTheOutlineAndNotOnWalls) {
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

INSTANTIATE_TEST_SUITE_P(Files, RealRooms, testing::Values("duplex", "AC20-FZK-Haus", "LargeBuilding"),
                         [](const testing::TestParamInfo<const char*>& info) {
                           std::string name = info.param;
                           std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
                           return name;
                         });

TEST(RealAdjacency, DuplexStairsJoinItsLevels) {
  const std::string path = data_path("ifc/duplex.ifc");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no test data at " << path;
  const Building building = read_ifc(path);
  std::map<Passage, int> count;
  std::set<std::pair<std::string, std::string>> stairs;
  for (const Adjacent& pair : adjacency(building)) {
    ++count[pair.by];
    if (pair.by == Passage::stair)
      stairs.insert(std::minmax(building.rooms[static_cast<std::size_t>(pair.a)].name,
                                building.rooms[static_cast<std::size_t>(pair.b)].name));
  }
  EXPECT_EQ(count[Passage::door], 14);
  EXPECT_EQ(stairs, (std::set<std::pair<std::string, std::string>>{{"Foyer A101", "Hallway A201"},
                                                                   {"Foyer B101", "Hallway B201"}}));
}

}  // namespace
}  // namespace plumbline::bim
