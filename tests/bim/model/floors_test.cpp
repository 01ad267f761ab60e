// SPDX-License-Identifier: Apache-2.0
#include "bim/model/floors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"
#include "tests/sanitized.h"

namespace plumbline::bim {
namespace {

Polygon2 box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

Slab slab(const Polygon2& outline, double z0, double z1) {
  Slab s;
  s.storey = 0;
  s.polygon = {outline, {}};
  s.z0_m = z0;
  s.z1_m = z1;
  return s;
}

/// The same with its body given, as IFC does.
Slab with_body(Slab s) {
  s.body = extrude({s.polygon}, s.z0_m, s.z1_m);
  return s;
}

Building two_storeys() {
  Building building;
  building.storeys.push_back({"s0", "s0", 0.0, 3.0, 0});
  building.storeys.push_back({"s1", "s1", 3.0, 3.0, 0});
  return building;
}

double total(const std::vector<FloorPiece>& pieces, int storey) {
  double sum = 0.0;
  for (const FloorPiece& p : pieces)
    if (p.storey == storey) sum += area({p.polygon});
  return sum;
}

const FloorPiece* at(const std::vector<FloorPiece>& pieces, const Eigen::Vector2d& p) {
  for (const FloorPiece& piece : pieces)
    if (contains(piece.polygon, p)) return &piece;
  return nullptr;
}

TEST(Floors, LieWhereTheSlabsAre) {
  Building building = two_storeys();
  building.slabs = {with_body(slab(box(0, 0, 5, 4), -0.2, 0.0)), with_body(slab(box(5, 0, 9, 4), 0.25, 0.45)),
                    with_body(slab(box(9, 0, 12, 4), -0.6, -0.4)), with_body(slab(box(0, 0, 12, 4), 2.8, 3.0))};
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_NEAR(at(pieces, {2, 2})->z_at({2, 2}), 0.0, 1e-9);
  EXPECT_NEAR(at(pieces, {7, 2})->z_at({7, 2}), 0.45, 1e-9);
  EXPECT_NEAR(at(pieces, {10, 2})->z_at({10, 2}), -0.4, 1e-9);
  EXPECT_NEAR(total(pieces, 0), 48.0, 1e-6);
  EXPECT_NEAR(total(pieces, 1), 48.0, 1e-6);
}

TEST(Floors, OfTwoWithoutHeadroomBetweenThemTheUpperCounts) {
  Building building = two_storeys();
  building.slabs = {slab(box(0, 0, 6, 4), -0.3, -0.1), slab(box(1, 1, 3, 3), -0.1, 0.05)};
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  EXPECT_NEAR(total(pieces, 0), 24.0, 1e-6);
  EXPECT_NEAR(at(pieces, {2, 2})->z_at({2, 2}), 0.05, 1e-9);
  EXPECT_NEAR(at(pieces, {5, 2})->z_at({5, 2}), -0.1, 1e-9);
}

TEST(Floors, AMezzanineIsOneMoreFloorAndABlockHidesWhatItStandsOn) {
  Building building = two_storeys();
  building.slabs = {slab(box(0, 0, 6, 4), -0.2, 0.0), slab(box(4, 0, 6, 4), 1.4, 1.5)};
  EXPECT_NEAR(total(floor_pieces(building), 0), 24.0 + 8.0, 1e-6);
  building.slabs[1].z0_m = 0.0;
  EXPECT_NEAR(total(floor_pieces(building), 0), 16.0 + 8.0, 1e-6);
}

TEST(Floors, ARampSlopes) {
  // 4 m long, 0.6 m high, on a slab; the slab is hidden under it.
  Building building = two_storeys();
  building.slabs = {slab(box(0, 0, 10, 2), -0.2, 0.0)};
  Obstacle ramp;
  ramp.kind = "ramp";
  ramp.storey = 0;
  ramp.body.vertices = {{3, 0, 0}, {7, 0, 0}, {7, 0, 0.6}, {3, 2, 0}, {7, 2, 0}, {7, 2, 0.6}};
  ramp.body.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
  building.obstacles = {ramp};
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  EXPECT_EQ(at(pieces, {6, 1})->source, FloorSource::obstacle);
  EXPECT_NEAR(at(pieces, {6, 1})->z_at({6, 1}), 0.45, 1e-6);
  EXPECT_NEAR(at(pieces, {4, 1})->z_at({4, 1}), 0.15, 1e-6);
  EXPECT_NEAR(at(pieces, {8, 1})->z_at({8, 1}), 0.0, 1e-9);
  // The slab is hidden up to where the ramp leaves 0.5 m over it.
  EXPECT_NEAR(total(pieces, 0), 20.0 + (0.6 - 0.5) / 0.15 * 2.0, 0.02);
}

Obstacle covering(const Polygon2& outline, double z0, double z1) {
  Obstacle o;
  o.kind = "covering";
  o.storey = 0;
  o.body = extrude({{outline, {}}}, z0, z1);
  return o;
}

TEST(Floors, WhatCoversASlabIsTheFloorAndWhatHangsUnderOneIsNot) {
  Building building = two_storeys();
  building.slabs = {slab(box(0, 0, 6, 4), -0.2, 0.0), slab(box(0, 0, 6, 4), 2.8, 3.0)};
  building.obstacles = {covering(box(0, 0, 3, 4), 0.0, 0.1), covering(box(0, 0, 6, 4), 2.5, 2.52),
                        covering(box(0, 0, 0.02, 4), 0.0, 2.5), covering(box(0, 0, 6, 0.02), 0.0, 0.1)};
  Obstacle around;  // a skirting board on all four sides
  around.kind = "covering";
  around.storey = 0;
  around.body = extrude({{box(0, 0, 6, 4), {{{0.02, 0.02}, {0.02, 3.98}, {5.98, 3.98}, {5.98, 0.02}}}}}, 0.0, 0.1);
  building.obstacles.push_back(around);
  for (const double room_m : {0.1, 0.0}) {
    Room room;
    room.storey = 0;
    room.polygon = box(0, 0, 6, 4);
    room.z0_m = room_m;
    building.rooms = {room};
    EXPECT_TRUE(is_floor_covering(building, building.obstacles[0]));
    EXPECT_FALSE(is_floor_covering(building, building.obstacles[1])) << "a ceiling";
    EXPECT_FALSE(is_floor_covering(building, building.obstacles[2])) << "a cladding";
    EXPECT_FALSE(is_floor_covering(building, building.obstacles[3])) << "a skirting board";
    EXPECT_FALSE(is_floor_covering(building, building.obstacles[4])) << "one around the room";
    const std::vector<FloorPiece> pieces = floor_pieces(building);
    EXPECT_NEAR(at(pieces, {2, 2})->z_at({2, 2}), 0.1, 1e-9);
    EXPECT_NEAR(at(pieces, {5, 2})->z_at({5, 2}), 0.0, 1e-9);
    EXPECT_NEAR(total(pieces, 0), 24.0, 1e-6);
  }
  building.rooms.clear();
  EXPECT_TRUE(is_floor_covering(building, building.obstacles[0])) << "at the storey's elevation";
  building.rooms.push_back({});
  building.rooms[0].storey = 0;
  building.rooms[0].polygon = box(0, 0, 6, 4);
  building.rooms[0].z0_m = 0.4;
  EXPECT_FALSE(is_floor_covering(building, building.obstacles[0])) << "lies below the floor";
}

TEST(Floors, RoomsAndThenWallsStandInForMissingSlabs) {
  Building building = two_storeys();
  Room room;
  room.storey = 0;
  room.polygon = box(0, 0, 3, 3);
  room.z0_m = 0.3;
  building.rooms = {room};
  room.polygon = box(3, 0, 6, 3);
  building.rooms.push_back(room);
  building.slabs = {slab(box(3, 0, 6, 3), 0.1, 0.3)};
  for (const auto& [a, b] : {std::pair<Eigen::Vector2d, Eigen::Vector2d>{{0, 0}, {8, 0}}, {{8, 0}, {8, 5}}}) {
    Wall wall;
    wall.storey = 1;
    wall.a = a;
    wall.b = b;
    building.walls.push_back(wall);
  }
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].source, FloorSource::room);
  EXPECT_NEAR(pieces[0].z_at({1, 1}), 0.3, 1e-9);
  EXPECT_EQ(pieces[1].source, FloorSource::slab);
  EXPECT_EQ(pieces[2].source, FloorSource::walls);
  EXPECT_EQ(pieces[2].storey, 1);
  EXPECT_NEAR(pieces[2].z_at({1, 1}), 3.0, 1e-9);
}

TEST(Floors, ARoomSaysWhichStoreyAHalfLevelBelongsTo) {
  Building building = two_storeys();
  building.slabs = {slab(box(0, 0, 3, 3), 1.9, 2.1), slab(box(4, 0, 7, 3), 1.9, 2.1)};
  EXPECT_NEAR(total(floor_pieces(building), 0), 18.0, 1e-6);
  Room room;
  room.storey = 1;
  room.polygon = box(4, 0, 7, 3);
  room.z0_m = 2.1;
  building.rooms = {room};
  EXPECT_NEAR(total(floor_pieces(building), 0), 9.0, 1e-6);
  EXPECT_NEAR(total(floor_pieces(building), 1), 9.0, 1e-6);
}

/// A plate between two heights of its upper face, at x = from and x = to, 6 m wide.
Slab sloping(double from, double to, double z_from, double z_to, double thickness) {
  Slab s = slab(box(from, 0, to, 6), std::min(z_from, z_to) - thickness, std::max(z_from, z_to));
  Solid body;
  for (const double down : {thickness, 0.0})
    for (const double y : {0.0, 6.0}) {
      body.vertices.emplace_back(from, y, z_from - down);
      body.vertices.emplace_back(to, y, z_to - down);
    }
  body.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  s.body = body;
  return s;
}

Solid both(const Solid& one, const Solid& other) {
  Solid joined = one;
  const auto first = static_cast<int>(one.vertices.size());
  joined.vertices.insert(joined.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& t : other.triangles) joined.triangles.emplace_back(t + Eigen::Vector3i::Constant(first));
  return joined;
}

/// Its underside begins below the floor of the attic and lies 2 m above it at the ridge.
TEST(Floors, APaneOfARoofLeavesTheAttic) {
  Building building = two_storeys();
  building.slabs = {with_body(slab(box(0, 0, 8, 6), 2.8, 3.0)), sloping(0, 8, 3.1, 5.5, 0.2)};
  double attic = 0.0;
  for (const FloorPiece& p : floor_pieces(building))
    if (p.element == 0) attic += area({p.polygon});
  // It begins where the pane's upper face is half a metre over it.
  EXPECT_NEAR(attic, 48.0 - 6.0 * (0.5 - 0.1) / 0.3, 0.02);
}

TEST(Floors, ARampOfOneThicknessLeavesTheFloorUnderIt) {
  Building building = two_storeys();
  building.slabs = {with_body(slab(box(-2, 0, 12, 6), -0.2, 0.0)), sloping(0, 10, 0.2, 3.0, 0.2)};
  EXPECT_NEAR(total(floor_pieces(building), 0), 14.0 * 6.0 + 10.0 * 6.0 - 6.0 * 0.3 / 0.28, 0.05);
}

TEST(Floors, TwoPlatesOfOneSlabAreTwoFloors) {
  Building building = two_storeys();
  Slab plates = slab(box(0, 0, 6, 4), -0.2, 3.0);
  plates.body = both(extrude({plates.polygon}, -0.2, 0.0), extrude({plates.polygon}, 2.8, 3.0));
  building.slabs = {plates};
  EXPECT_NEAR(total(floor_pieces(building), 0), 24.0, 1e-6);
  EXPECT_NEAR(total(floor_pieces(building), 1), 24.0, 1e-6);
}

TEST(Floors, AColumnInTheBodyOfADeckHidesOnlyWhatItStandsOn) {
  Building building = two_storeys();
  Slab deck = slab(box(0, 0, 6, 4), 0.0, 3.0);
  deck.body = both(extrude({deck.polygon}, 2.8, 3.0), extrude({{box(2, 2, 2.4, 2.4), {}}}, 0.0, 2.8));
  building.slabs = {with_body(slab(box(0, 0, 6, 4), -0.2, 0.0)), deck};
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  EXPECT_NEAR(total(pieces, 0), 24.0 - 0.16, 1e-6);
  EXPECT_NEAR(total(pieces, 1), 24.0, 1e-6);
}

/// An upper face of steps x steps squares in two triangles each, not level.
Slab uneven(double size, int steps, double rise) {
  Slab s = slab(box(0, 0, size, size), -0.3, rise);
  Solid body;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      body.vertices.emplace_back(size * i / steps, size * j / steps, rise * ((7 * i + 5 * j + i * j) % 11) / 11.0);
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const int a = i * (steps + 1) + j, b = a + steps + 1;
      body.triangles.emplace_back(a, b, b + 1);
      body.triangles.emplace_back(a, b + 1, a + 1);
    }
  s.body = body;
  return s;
}

/// No triangle has the area that a floor has at least.
TEST(Floors, AnUnevenSlabInSmallTrianglesIsAFloor) {
  Building building = two_storeys();
  building.slabs = {uneven(4.0, 80, 0.01)};
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  EXPECT_NEAR(total(pieces, 0), 16.0, 0.1);
  EXPECT_LT(pieces.size(), 200u);
  for (const FloorPiece& piece : pieces) {
    const Eigen::Vector2d p = piece.polygon.outer.front();
    EXPECT_NEAR(piece.z_at(p), 0.005, 0.02);
  }
}

TEST(Floors, AnUnevenSlabIsReadInTime) {
  Building building = two_storeys();
  building.slabs = {uneven(12.0, 40, 0.1)};
  const std::clock_t begin = std::clock();
  EXPECT_NEAR(total(floor_pieces(building), 0), 144.0, 1e-3);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 3.0 * slower);  // CPU time
}

TEST(AssumedSlabs, LieUnderRoomsOrBeyondWallsWhereAStoreyHasNone) {
  Building rooms = two_storeys();
  rooms.rooms.push_back({});
  rooms.rooms.back().storey = 0;
  rooms.rooms.back().polygon = box(0, 0, 4, 3);
  rooms.rooms.back().z0_m = 0.1;
  const std::vector<Slab> under = assumed_slabs(rooms);
  ASSERT_EQ(under.size(), 1U);
  EXPECT_TRUE(under[0].assumed);
  EXPECT_EQ(under[0].z1_m, 0.1);
  EXPECT_NEAR(std::abs(signed_area(under[0].polygon.outer)), 12.0, 1e-9);
  rooms.slabs.push_back(slab(box(-1, -1, 5, 4), -0.2, 0.1));
  EXPECT_TRUE(assumed_slabs(rooms).empty());

  Building walls = two_storeys();
  for (const double y : {0.0, 6.0}) {
    Wall wall;
    wall.storey = 0;
    wall.a = {0.0, y};
    wall.b = {8.0, y};
    wall.thickness_m = 0.0;
    walls.walls.push_back(wall);
  }
  const std::vector<Slab> beyond = assumed_slabs(walls, 2.0);
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_NEAR(std::abs(signed_area(beyond[0].polygon.outer)), 12.0 * 10.0, 1e-9);
  walls.stairs.emplace_back();
  EXPECT_TRUE(assumed_slabs(walls).empty());
}

}  // namespace
}  // namespace plumbline::bim
