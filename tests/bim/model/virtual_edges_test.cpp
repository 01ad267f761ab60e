// SPDX-License-Identifier: Apache-2.0
#include "bim/model/virtual_edges.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/model/adjacency.h"

namespace plumbline::bim {
namespace {

/// Two rooms of 4 x 5 side by side in an outer box of 8 x 5; of the wall between them only what `between` says.
Building open_plan(const std::string& between, const std::string& more = "") {
  return read_plan_text(
      "plan: 1\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\nwalls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [8, 0], thickness_m: 0.2}\n"
      "  - {id: e, storey: g, a: [8, 0], b: [8, 5], thickness_m: 0.2}\n"
      "  - {id: n, storey: g, a: [8, 5], b: [0, 5], thickness_m: 0.2}\n"
      "  - {id: w, storey: g, a: [0, 5], b: [0, 0], thickness_m: 0.2}\n" +
          between +
          "rooms:\n  - {id: left, storey: g, polygon: [[0, 0], [4, 0], [4, 5], [0, 5]]}\n"
          "  - {id: right, storey: g, polygon: [[4, 0], [8, 0], [8, 5], [4, 5]]}\n" +
          more,
      "plan.yaml");
}

TEST(VirtualEdges, WallBetweenRoomsLeavesNone) {
  const Building building = open_plan("  - {id: m, storey: g, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n");
  for (const Room& room : building.rooms) EXPECT_TRUE(room.virtual_edges.empty()) << room.id;
  EXPECT_TRUE(adjacency(building).empty());
}

TEST(VirtualEdges, GapOfAHalfWallIsOneEdgeToTheNeighbour) {
  const Building building = open_plan("  - {id: m, storey: g, a: [4, 0], b: [4, 2], thickness_m: 0.1}\n");
  ASSERT_EQ(building.rooms[0].virtual_edges.size(), 1u);
  ASSERT_EQ(building.rooms[1].virtual_edges.size(), 1u);
  const VirtualEdge& edge = building.rooms[0].virtual_edges.front();
  EXPECT_EQ(edge.room, 1);
  EXPECT_EQ(building.rooms[1].virtual_edges.front().room, 0);
  // From 50 mm past the wall's end to the clear face of the other wall.
  EXPECT_NEAR(edge.a.y(), 2.05, 1e-9);
  EXPECT_NEAR(edge.b.y(), 4.85, 1e-9);
  const std::vector<Adjacent> pairs = adjacency(building);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs.front().by, Passage::open_edge);
  EXPECT_NEAR(pairs.front().width_m, 2.8, 1e-9);
}

TEST(VirtualEdges, OutsideIsMinusOne) {
  Building building = open_plan("");
  building.walls.erase(building.walls.begin());  // the south wall
  find_virtual_edges(building);
  int outside = 0;
  for (const Room& room : building.rooms)
    for (const VirtualEdge& edge : room.virtual_edges) outside += edge.room < 0 ? 1 : 0;
  EXPECT_EQ(outside, 2);
}

TEST(VirtualEdges, AWallAboveOrBelowTheRoomClosesNothing) {
  Building building = open_plan("  - {id: m, storey: g, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n");
  building.walls.back().z0_m = 3.1;
  building.walls.back().z1_m = 6.0;
  find_virtual_edges(building);
  EXPECT_EQ(building.rooms[0].virtual_edges.size(), 1u);
}

TEST(VirtualEdges, CurtainPanelsAndLooseLayersCloseAnEdge) {
  Building building = open_plan("");
  ASSERT_EQ(building.rooms[0].virtual_edges.size(), 1u);
  Obstacle panel;
  panel.id = "p";
  for (const double x : {3.99, 4.01})
    for (const double y : {0.0, 5.0})
      for (const double z : {0.0, 3.0}) panel.body.vertices.emplace_back(x, y, z);
  building.obstacles.push_back(panel);
  for (const char* kind : {"curtain_panel", "part"}) {
    building.obstacles.back().kind = kind;
    find_virtual_edges(building);
    EXPECT_TRUE(building.rooms[0].virtual_edges.empty()) << kind;
  }
}

Obstacle plate(double x0, double x1) {
  Obstacle plate;
  plate.kind = "plate";
  for (const double x : {x0, x1})
    for (const double y : {0.0, 5.0})
      for (const double z : {0.0, 3.0}) plate.body.vertices.emplace_back(x, y, z);
  return plate;
}

/// What lies nearer than the first point that is looked at, or between two of them, stands in the way as well.
TEST(VirtualEdges, NoRoomLiesBeyondAThinPane) {
  struct Case {
    double left_x, right_x, pane_x0, pane_x1;
  };
  for (const Case& c : {Case{3.8, 4.2, 3.99, 4.01}, Case{3.0, 3.8, 3.5 + 0.01, 3.5 + 0.03}}) {
    Building building = open_plan("");
    building.rooms[0].polygon = {{0.1, 0.1}, {c.left_x, 0.1}, {c.left_x, 4.9}, {0.1, 4.9}};
    building.rooms[1].polygon = {{c.right_x, 0.1}, {7.9, 0.1}, {7.9, 4.9}, {c.right_x, 4.9}};
    find_virtual_edges(building);
    const std::vector<Adjacent> open = adjacency(building);
    ASSERT_EQ(open.size(), 1u) << c.left_x;
    EXPECT_EQ(open.front().by, Passage::open_edge);
    building.obstacles = {plate(c.pane_x0, c.pane_x1)};
    find_virtual_edges(building);
    EXPECT_TRUE(adjacency(building).empty()) << c.left_x;
  }
}

TEST(VirtualEdges, APostWithinTheRoomBeyondHidesItNot) {
  Building building = open_plan("");
  building.rooms[0].polygon = {{0.1, 0.1}, {3.9, 0.1}, {3.9, 4.9}, {0.1, 4.9}};
  building.columns.push_back({"c", 0, {{4.1, 2.2}, {4.5, 2.2}, {4.5, 2.8}, {4.1, 2.8}}, 0.0, 3.0, "", {}, 0});
  find_virtual_edges(building);
  const std::vector<VirtualEdge>& edges = building.rooms[0].virtual_edges;
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges.front().room, 1);
}

TEST(Adjacency, NamesDoorsWindowsAndVoids) {
  const Building building =
      open_plan("  - {id: m, storey: g, a: [4, 0], b: [4, 5], thickness_m: 0.1}\n",
                "openings:\n  - {id: d, wall: m, kind: door, s_m: 1, width_m: 0.9, height_m: 2}\n"
                "  - {id: v, wall: m, kind: void, s_m: 3, width_m: 0.9, height_m: 2}\n"
                "  - {id: o, wall: s, kind: window, s_m: 1, width_m: 1, height_m: 1, sill_m: 1}\n");
  const std::vector<Adjacent> pairs = adjacency(building);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].b, -1);
  EXPECT_EQ(pairs[0].by, Passage::window);
  EXPECT_EQ(pairs[1].by, Passage::door);
  EXPECT_EQ(pairs[1].element, "d");
  EXPECT_EQ(pairs[2].by, Passage::opening_void);
}

/// Of walls before each other, in a building without rooms.
TEST(Adjacency, AHoleThroughTwoWallsIsOneWithoutRooms) {
  Building building;
  for (const double y : {0.0, 0.3, 2.0}) {
    Wall wall;
    wall.a = {0, y};
    wall.b = {8, y};
    Opening hole;
    hole.kind = OpeningKind::opening_void;
    hole.s_m = 3.0;
    hole.wall = static_cast<int>(building.walls.size());
    building.walls.push_back(wall);
    building.openings.push_back(hole);
  }
  EXPECT_EQ(continued_openings(building), (std::vector<bool>{false, true, false}));
}

/// A flight from one room up into another, on the storey above.
TEST(Adjacency, StairJoinsRoomsAcrossStoreys) {
  Building building;
  building.storeys = {{"g", "", 0.0, 3.0}, {"u", "", 3.0, 3.0}};
  Room low;
  low.storey = 0;
  low.polygon = {{0, 0}, {8, 0}, {8, 4}, {0, 4}};
  Room high = low;
  high.storey = 1;
  high.z0_m = 3.0;
  high.z1_m = 6.0;
  building.rooms = {low, high};
  Stair stair;
  stair.id = "stair";
  stair.from = 0;
  stair.to = 1;
  stair.flights.push_back({{1.0, 2.0}, 0.0, 1.0, 0.0, 15, 0.1875, 0.25});
  building.stairs.push_back(stair);
  find_stair_rooms(building);
  const std::vector<Adjacent> pairs = adjacency(building);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].a, 0);
  EXPECT_EQ(pairs[0].b, 1);
  EXPECT_EQ(pairs[0].by, Passage::stair);
}

}  // namespace
}  // namespace plumbline::bim
