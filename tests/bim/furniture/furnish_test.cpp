// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/furnish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/visit.h"
#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/furniture/room_space.h"
#include "bim/model/extrude.h"
#include "tests/bim/furniture/walkable.h"

namespace plumbline::bim {
namespace {

/// A flat of five rooms with a stair to a storey above; things stand in the way.
const std::string flat =
    "plan: 1\n"
    "storeys: [{id: g, height_m: 2.8}, {id: u, elevation_m: 3}]\n"
    "walls:\n"
    "  - {id: s, storey: g, a: [0, 0], b: [14, 0]}\n"
    "  - {id: e, storey: g, a: [14, 0], b: [14, 10]}\n"
    "  - {id: n, storey: g, a: [14, 10], b: [0, 10]}\n"
    "  - {id: w, storey: g, a: [0, 10], b: [0, 0]}\n"
    "  - {id: m, storey: g, a: [0, 4.5], b: [14, 4.5]}\n"
    "  - {id: p1, storey: g, a: [5, 0], b: [5, 4.5]}\n"
    "  - {id: p2, storey: g, a: [10, 0], b: [10, 4.5]}\n"
    "  - {id: p3, storey: g, a: [6, 4.5], b: [6, 10]}\n"
    "  - {id: us, storey: u, a: [0, 4], b: [14, 4]}\n"
    "  - {id: ue, storey: u, a: [14, 4], b: [14, 10]}\n"
    "  - {id: un, storey: u, a: [14, 10], b: [0, 10]}\n"
    "  - {id: uw, storey: u, a: [0, 10], b: [0, 4]}\n"
    "openings:\n"
    "  - {id: d1, wall: m, s_m: 2.5}\n"
    "  - {id: d2, wall: m, s_m: 8}\n"
    "  - {id: d3, wall: m, s_m: 12}\n"
    "  - {id: d4, wall: p3, s_m: 1.5, width_m: 1.2}\n"
    "  - {id: d5, wall: p1, s_m: 1.5}\n"
    "rooms:\n"
    "  - {id: schlafzimmer, storey: g, polygon: [[0, 0], [5, 0], [5, 4.5], [0, 4.5]]}\n"
    "  - {id: küche, storey: g, polygon: [[5, 0], [10, 0], [10, 4.5], [5, 4.5]]}\n"
    "  - {id: office, storey: g, polygon: [[10, 0], [14, 0], [14, 4.5], [10, 4.5]]}\n"
    "  - {id: wohnzimmer, storey: g, polygon: [[0, 4.5], [6, 4.5], [6, 10], [0, 10]]}\n"
    "  - {id: hall, storey: g, polygon: [[6, 4.5], [14, 4.5], [14, 10], [6, 10]]}\n"
    "  - {id: loft, storey: u, polygon: [[0, 4], [14, 4], [14, 10], [0, 10]]}\n"
    "columns: [{id: c, storey: g, at: [3, 7], size: [0.4, 0.4], yaw_deg: 30}]\n"
    "stairs: [{id: st, from: g, to: u, start: [7.5, 9], yaw_deg: 0}]\n"
    "clutter:\n"
    "  - {id: furniture_2, storey: g, shape: box, at: [2.5, 2], size: [1, 1]}\n"
    "  - {id: bin, storey: g, shape: cylinder, at: [8, 2], size: [0.5, 0.5]}\n";

Building building() { return read_plan_text(flat, "flat.plan.yaml"); }

/// One room with a door.
Building single_room(const std::string& id, double x, double y) {
  const std::string w = std::to_string(x), d = std::to_string(y);
  return read_plan_text(
      "plan: 1\nstoreys: [{id: g}]\nwalls:\n"
      "  - {id: s, storey: g, a: [0, 0], b: [" +
          w +
          ", 0]}\n"
          "  - {id: e, storey: g, a: [" +
          w + ", 0], b: [" + w + ", " + d +
          "]}\n"
          "  - {id: n, storey: g, a: [" +
          w + ", " + d + "], b: [0, " + d +
          "]}\n"
          "  - {id: w, storey: g, a: [0, " +
          d +
          "], b: [0, 0]}\n"
          "openings: [{id: door, wall: s, s_m: 2}]\n"
          "rooms: [{id: " +
          id + ", storey: g, polygon: [[0, 0], [" + w + ", 0], [" + w + ", " + d + "], [0, " + d + "]]}]\n",
      "room.plan.yaml");
}

FurnishOptions options(double density, std::uint64_t seed = 1) {
  FurnishOptions options;
  options.density = density;
  options.seed = seed;
  return options;
}

Polygon2 outline_of(const FurniturePiece& piece) {
  const Obstacle obstacle = obstacle_of(piece);
  return hull_of(obstacle);
}

std::vector<Polygon2> standing(const Building& b) {
  std::vector<Polygon2> outlines;
  for (const Column& column : b.columns) outlines.push_back(column.footprint);
  for (const Obstacle& obstacle : b.obstacles) outlines.push_back(hull_of(obstacle));
  for (const Stair& stair : b.stairs) {
    Polygon2 points;
    for (const Solid& solid : stair.bodies)
      for (const Eigen::Vector3d& p : solid.vertices) points.push_back(p.head<2>());
    outlines.push_back(convex_hull(points));
  }
  return outlines;
}

double share(const Building& b, const std::vector<FurniturePiece>& pieces, std::size_t room) {
  double covered = 0.0;
  for (const FurniturePiece& piece : pieces)
    if (piece.room == static_cast<int>(room)) covered += piece.size.prod();
  return covered / signed_area(b.rooms[room].polygon);
}

std::string text_of(const std::vector<FurniturePiece>& pieces) {
  std::string text;
  for (const FurniturePiece& p : pieces)
    text += p.id + " " + std::string(EnumNames<FurnitureShape>::names[static_cast<std::size_t>(p.shape)]) + " " +
            std::to_string(p.at.x()) + " " + std::to_string(p.at.y()) + " " + std::to_string(p.size.x()) + " " +
            std::to_string(p.size.y()) + " " + std::to_string(p.yaw_deg) + " " + std::to_string(p.height_m) + "\n";
  return text;
}

class FurnishDensity : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Furnish, FurnishDensity, testing::Values(0.05, 0.1, 0.2, 0.3, 0.4));

TEST_P(FurnishDensity, PiecesAreInTheirRoomsAndApart) {
  const Building b = building();
  const std::vector<FurniturePiece> pieces = furnish_pieces(b, options(GetParam()));
  ASSERT_FALSE(pieces.empty());
  // What stands on the ground floor, and the stair, which is in the way above too.
  std::vector<std::vector<Polygon2>> others = {standing(b), {standing(b).back()}};
  for (const FurniturePiece& piece : pieces) {
    const Polygon2 outline = outline_of(piece);
    const Room& room = b.rooms[static_cast<std::size_t>(piece.room)];
    EXPECT_NEAR(intersection_area(outline, room.polygon), signed_area(outline), 1e-6) << piece.id;
    for (const Eigen::Vector2d& p : outline) EXPECT_GT(boundary_distance(room.polygon, p), 0.049) << piece.id;
    EXPECT_EQ(piece.storey, room.storey);
    EXPECT_LT(piece.floor_z_m + piece.height_m, room.z1_m);
    std::vector<Polygon2>& beside = others.at(static_cast<std::size_t>(piece.storey));
    for (const Polygon2& other : beside) EXPECT_LT(intersection_area(outline, other), 1e-9) << piece.id;
    beside.push_back(outline);
  }
}

TEST_P(FurnishDensity, DoorsStayConnected) {
  const Building b = building();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (int storey = 0; storey < 2; ++storey) {
      Building floor = b;
      std::erase_if(floor.rooms, [&](const Room& room) { return room.storey != storey; });
      std::vector<Polygon2> before, after;
      // The obstacles and the column are on the ground floor; the stair is in the way on both.
      if (storey == 0) before = standing(b);
      if (storey == 1) before = {standing(b).back()};
      after = before;
      for (const FurniturePiece& piece : furnish_pieces(b, options(GetParam(), seed)))
        if (piece.storey == storey) after.push_back(outline_of(piece));
      expect_walkable(floor, before, after);
    }
  }
}

TEST_P(FurnishDensity, FloorBeforeDoorsAndAtStairsIsFree) {
  const Building b = building();
  std::vector<std::pair<int, Polygon2>> areas;  // with their storey
  for (const Opening& opening : b.openings) {
    const Wall& wall = b.walls[static_cast<std::size_t>(opening.wall)];
    const Eigen::Vector2d e = wall.direction(), middle = wall.a + opening.s_m * e;
    const Eigen::Vector2d u = (0.5 * opening.width_m + 0.1) * e, v = (0.5 * wall.thickness_m + 0.8) * wall.left();
    areas.push_back({wall.storey, {middle - u - v, middle + u - v, middle + u + v, middle - u + v}});
  }
  const StairFlight& flight = b.stairs.front().flights.front();
  const double x = flight.start.x(), y = flight.start.y(), half = 0.5 * flight.width_m;
  const double head = x + flight.steps * flight.run_m;
  areas.push_back({0, {{x - 0.8, y - half}, {x, y - half}, {x, y + half}, {x - 0.8, y + half}}});
  areas.push_back({1, {{head, y - half}, {head + 0.8, y - half}, {head + 0.8, y + half}, {head, y + half}}});
  for (const FurniturePiece& piece : furnish_pieces(b, options(GetParam())))
    for (const auto& [storey, area] : areas)
      EXPECT_TRUE(piece.storey != storey || intersection_area(outline_of(piece), area) < 1e-9) << piece.id;
}

/// Of a large room so much is reached; the last piece may miss the target by half of itself, at most 2 m2.
TEST_P(FurnishDensity, IsReachedInALargeRoom) {
  for (const std::string id : {"office", "store", "hall", "classroom"}) {
    const Building b = single_room(id, 14.0, 10.0);
    const double reached = share(b, furnish_pieces(b, options(GetParam())), 0);
    RecordProperty(id, std::to_string(reached));
    EXPECT_NEAR(reached, GetParam(), 0.015) << id;
  }
}

TEST(Furnish, TheSameSeedGivesTheSamePieces) {
  const Building b = building();
  EXPECT_EQ(text_of(furnish_pieces(b, options(0.2, 5))), text_of(furnish_pieces(b, options(0.2, 5))));
  EXPECT_NE(text_of(furnish_pieces(b, options(0.2, 5))), text_of(furnish_pieces(b, options(0.2, 6))));
}

TEST(Furnish, ARoomDoesNotDependOnOthers) {
  const Building all = building();
  Building fewer = all;
  std::erase_if(fewer.rooms, [](const Room& room) { return room.id == "schlafzimmer"; });
  for (Opening& opening : fewer.openings)
    for (int& room : opening.rooms) room = -1;
  const auto in_room = [](const Building& b, const std::string& id) {
    std::vector<FurniturePiece> pieces = furnish_pieces(b, options(0.2));
    std::erase_if(pieces, [&](const FurniturePiece& p) { return b.rooms[static_cast<std::size_t>(p.room)].id != id; });
    for (FurniturePiece& piece : pieces) piece.id.clear();
    return text_of(pieces);
  };
  for (const std::string id : {"küche", "office", "wohnzimmer", "hall", "loft"})
    EXPECT_EQ(in_room(all, id), in_room(fewer, id)) << id;
}

TEST(Furnish, RoomsGetWhatTheirNamesSay) {
  const Building b = building();
  std::map<std::string, std::set<FurnitureShape>> shapes;
  for (const FurniturePiece& piece : furnish_pieces(b, options(0.25)))
    shapes[b.rooms[static_cast<std::size_t>(piece.room)].id].insert(piece.shape);
  EXPECT_TRUE(shapes["schlafzimmer"].contains(FurnitureShape::bed));
  EXPECT_TRUE(shapes["küche"].contains(FurnitureShape::kitchen));
  EXPECT_TRUE(shapes["office"].contains(FurnitureShape::desk));
  EXPECT_TRUE(shapes["wohnzimmer"].contains(FurnitureShape::sofa));
  EXPECT_FALSE(shapes["office"].contains(FurnitureShape::bed));
}

TEST(Furnish, ObstaclesArePlannedFurnitureWithUnusedIds) {
  const Building b = building();
  std::set<std::string> ids;
  for (const Obstacle& obstacle : b.obstacles) ids.insert(obstacle.id);
  const std::vector<Obstacle> obstacles = furnish(b, options(0.2));
  EXPECT_EQ(obstacles.size(), furnish_pieces(b, options(0.2)).size());
  for (const Obstacle& obstacle : obstacles) {
    EXPECT_TRUE(ids.insert(obstacle.id).second) << obstacle.id;
    EXPECT_EQ(obstacle.id.rfind("furniture_", 0), 0U);
    EXPECT_EQ(obstacle.kind, "furniture");
    EXPECT_TRUE(obstacle.planned);
  }
}

TEST(Furnish, PeopleTakeThePlacesOfChairs) {
  const Building b = building();
  FurnishOptions with = options(0.2);
  with.people = 4;
  const std::vector<FurniturePiece> bare = furnish_pieces(b, options(0.2)), seated = furnish_pieces(b, with);
  ASSERT_EQ(bare.size(), seated.size());
  int people = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_EQ(bare[i].at, seated[i].at);
    if (seated[i].shape != FurnitureShape::person) continue;
    EXPECT_EQ(bare[i].shape, FurnitureShape::chair);
    ++people;
  }
  EXPECT_EQ(people, 4);
}

TEST(Furnish, NothingAtDensityZeroAndNothingInRoomsTooNarrow) {
  EXPECT_TRUE(furnish(building(), options(0.0)).empty());
  EXPECT_TRUE(furnish(single_room("store", 4.0, 0.9), options(0.4)).empty());
}

TEST(Furnish, RoomsTooLargeForTheGridStayEmpty) {
  EXPECT_TRUE(furnish(single_room("hall", 900.0, 900.0), options(0.1)).empty());
}

TEST(Furnish, OptionsHaveTheirRanges) {
  EXPECT_NO_THROW((void)from_tree<FurnishOptions>(read_yaml("{density: 0.4, seed: 3, people: 50}", "f")));
  for (const std::string text : {"{density: 0.41}", "{density: -0.1}", "{people: 51}", "{peopl: 1}"})
    EXPECT_THROW((void)from_tree<FurnishOptions>(read_yaml(text, "f")), InputError) << text;
}

TEST(Furnish, NothingStandsWhereWallsShutTheRobotOut) {
  Building b = single_room("lounge", 12.0, 10.0);
  const Polygon2 core = {{2.0, 2.0}, {10.0, 2.0}, {10.0, 8.0}, {2.0, 8.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    Wall wall = b.walls[0];
    wall.id = "core" + std::to_string(i);
    wall.a = core[i];
    wall.b = core[(i + 1) % 4];
    b.walls.push_back(wall);
  }
  const double around_m2 = signed_area(b.rooms[0].polygon) - signed_area(core);
  for (const double density : {0.05, 0.15, 0.4}) {
    const std::vector<FurniturePiece> pieces = furnish_pieces(b, options(density));
    EXPECT_FALSE(pieces.empty());
    for (const FurniturePiece& piece : pieces) EXPECT_FALSE(contains(core, piece.at)) << piece.at.transpose();
    EXPECT_LT(share(b, pieces, 0) * signed_area(b.rooms[0].polygon), density * around_m2 + 2.0);
  }
  b.openings.clear();
  const std::vector<FurniturePiece> pieces = furnish_pieces(b, options(0.15));
  EXPECT_TRUE(std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) { return contains(core, piece.at); }))
      << "nothing tells from where the robot comes";
}

TEST(Furnish, WhatIsHighUpOnAColumnTakesNoFloor) {
  Building b = single_room("hall", 12.0, 10.0);
  Column column;
  column.id = "mushroom";
  column.storey = 0;
  column.footprint = {{4, 3}, {8, 3}, {8, 7}, {4, 7}};
  column.body = extrude({{{{5.8, 4.8}, {6.2, 4.8}, {6.2, 5.2}, {5.8, 5.2}}, {}}}, 0.0, 2.5);
  const Solid head = extrude({{column.footprint, {}}}, 2.5, 3.0);
  for (const Eigen::Vector3i& t : head.triangles)
    column.body->triangles.emplace_back(t.array() + static_cast<int>(column.body->vertices.size()));
  column.body->vertices.insert(column.body->vertices.end(), head.vertices.begin(), head.vertices.end());
  b.columns.push_back(column);
  RoomSpace space(b.rooms[0]);
  for (Footprint& footprint : Surroundings(b).near(space.box(), 0.0, {}, space.config()))
    space.add(std::move(footprint));
  EXPECT_GT(space.clearance({5.0, 4.0}), 0.5);
  EXPECT_LT(space.clearance({5.7, 5.0}), 0.2);
}

}  // namespace
}  // namespace plumbline::bim
