// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/symmetry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/load/load.h"
#include "bim/random/stream.h"
#include "bim/symmetry/symmetry_bodies.h"
#include "tests/bim/symmetry/moved.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

constexpr double half_turn = std::numbers::pi;

std::string wall(const std::string& id, Eigen::Vector2d a, Eigen::Vector2d b) {
  return "  - {id: " + id + ", storey: ground, a: [" + format_number(a.x()) + ", " + format_number(a.y()) + "], b: [" +
         format_number(b.x()) + ", " + format_number(b.y()) + "], thickness_m: 0.2}\n";
}

/// A box of rooms; further sections follow.
Building box(double width, double depth, const std::string& more) {
  return read_plan_text("plan: 1\nname: box\nstoreys: [{id: ground, elevation_m: 0, height_m: 3}]\nwalls:\n" +
                            wall("s", {0, 0}, {width, 0}) + wall("e", {width, 0}, {width, depth}) +
                            wall("n", {width, depth}, {0, depth}) + wall("w", {0, depth}, {0, 0}) + more,
                        "box.plan.yaml");
}

std::string room(double width, double depth) {
  return "rooms: [{id: hall, storey: ground, polygon: [[0, 0], [" + format_number(width) + ", 0], [" +
         format_number(width) + ", " + format_number(depth) + "], [0, " + format_number(depth) + "]]}]\n";
}

/// Underside and top of a quadrangle, cut from its first corner to its third.
Solid body_over(const Polygon2& outline, double z0, double z1) {
  Solid solid;
  for (const double z : {z0, z1})
    for (const Eigen::Vector2d& p : outline) solid.vertices.emplace_back(p.x(), p.y(), z);
  solid.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  return solid;
}

/// Two rooms that a half turn swaps; the door in the south may be shifted from its place.
Building twins(double shift_m) {
  return box(10, 6,
             wall("m", {5, 0}, {5, 6}) +
                 "openings:\n"
                 "  - {id: middle, wall: m, kind: door, s_m: 3, width_m: 1}\n"
                 "  - {id: south, wall: s, kind: door, s_m: " +
                 format_number(2 + shift_m) +
                 ", width_m: 1}\n"
                 "  - {id: north, wall: n, kind: door, s_m: 2, width_m: 1}\n"
                 "rooms:\n"
                 "  - {id: west, storey: ground, polygon: [[0, 0], [5, 0], [5, 6], [0, 6]]}\n"
                 "  - {id: east, storey: ground, polygon: [[5, 0], [10, 0], [10, 6], [5, 6]]}\n");
}

/// Makes the floor of the east room of the twins lie higher.
void raise_east(Building& building, double by_m) {
  Slab slab;
  slab.id = "raised";
  slab.storey = 0;
  slab.polygon.outer = {{5.1, 0.1}, {9.9, 0.1}, {9.9, 5.9}, {5.1, 5.9}};
  slab.z0_m = -0.1;
  slab.z1_m = by_m;
  building.slabs.push_back(slab);
  building.rooms[0].polygon = {{0.1, 0.1}, {4.9, 0.1}, {4.9, 5.9}, {0.1, 5.9}};
}

/// Boxes drawn at random: no symmetry.
Building random_building(std::uint64_t seed) {
  const Stream stream(seed, "bim.generate");
  const auto u = [&](std::uint32_t lane) { return stream.uniform(0, lane); };
  std::string clutter = "clutter:\n";
  for (std::uint32_t i = 0; i < 5; ++i)
    clutter += "  - {id: c" + std::to_string(i) + ", storey: ground, at: [" + format_number(1 + 9 * u(10 * i)) + ", " +
               format_number(1 + 5 * u(10 * i + 1)) + "], size: [" + format_number(0.6 + u(10 * i + 2)) + ", " +
               format_number(0.6 + u(10 * i + 3)) + "], yaw_deg: " + format_number(90 * u(10 * i + 4)) +
               ", height_m: " + format_number(0.5 + u(10 * i + 5)) + "}\n";
  return box(11, 7, room(11, 7) + clutter);
}

bool has(const std::vector<BuildingSymmetry>& group, const Isometry2& g, double angle_tol, double shift_tol) {
  const Eigen::Vector2d probe(3.0, 2.0);
  return std::any_of(group.begin(), group.end(), [&](const BuildingSymmetry& symmetry) {
    const double turn = std::abs(std::remainder(symmetry.isometry.angle - g.angle, 2.0 * std::numbers::pi));
    return turn < angle_tol && (symmetry.isometry * probe - g * probe).norm() < shift_tol;
  });
}

TEST(Symmetry, HalvesAtDifferentHeightsAreNotAlike) {
  Building building = twins(0.0);
  ASSERT_FALSE(analyse_symmetry(building).building.empty());
  raise_east(building, 0.4);
  EXPECT_TRUE(analyse_symmetry(building).building.empty());
}

/// One below what counts as exact.
TEST(Symmetry, AStepOfMillimetresOnAWallIsNoDifference) {
  for (const double step_m : {0.003, 0.1}) {
    Building building = twins(0.0);
    Wall cap = building.walls[0];
    cap.id = "cap";
    cap.thickness_m = 0.1;
    cap.z0_m = 2.4;  // above the door
    building.walls[0].z1_m = 2.5;
    building.walls[2].z1_m = 2.5;
    cap.z1_m = 2.5 + step_m;
    building.walls.push_back(cap);
    const SymmetryReport report = analyse_symmetry(building);
    const bool exact = !report.building.empty() && report.building.front().similarity.grade == SimilarityGrade::exact;
    EXPECT_EQ(exact, step_m < 0.006) << step_m;
  }
}

/// A platform of the shape of a plus, with a pit in its middle.
TEST(Symmetry, RaisedFloorsNeedNotBeConvex) {
  Building building = box(6, 6, room(6, 6));
  Slab slab;
  slab.id = "plus";
  slab.storey = 0;
  slab.polygon.outer = {{2, 1}, {4, 1}, {4, 2}, {5, 2}, {5, 4}, {4, 4}, {4, 5}, {2, 5}, {2, 4}, {1, 4}, {1, 2}, {2, 2}};
  slab.polygon.holes = {{{2.5, 2.5}, {2.5, 3.5}, {3.5, 3.5}, {3.5, 2.5}}};
  slab.z0_m = -0.1;
  slab.z1_m = 0.4;
  building.slabs.push_back(slab);
  const SymmetryBodies bodies = symmetry_bodies(building, 0);
  double platform = 0.0;
  for (const BodyPrism& prism : bodies.prisms)
    if (bodies.elements[static_cast<std::size_t>(prism.element)].starts_with("floor"))
      platform += signed_area(prism.outline);
  EXPECT_NEAR(platform, 11.0, 1e-6);
  const SymmetryReport report = analyse_symmetry(building);
  ASSERT_EQ(report.building.size(), 3U);
  for (const BuildingSymmetry& symmetry : report.building) EXPECT_EQ(symmetry.similarity.grade, SimilarityGrade::exact);
}

TEST(Symmetry, SquareHasThreeTurnsAndItsMirrorImagesApart) {
  const SymmetryReport report = analyse_symmetry(box(6, 6, room(6, 6)));
  ASSERT_EQ(report.building.size(), 3U);
  for (int k = 1; k < 4; ++k)
    EXPECT_TRUE(has(report.building, Isometry2::turn(k * half_turn / 2, {3, 3}), 1e-9, 1e-9)) << k;
  for (const BuildingSymmetry& symmetry : report.building) {
    EXPECT_EQ(symmetry.similarity.grade, SimilarityGrade::exact);
    EXPECT_NEAR(symmetry.similarity.iou, 1.0, 1e-9);
    EXPECT_FALSE(symmetry.isometry.mirrored);
  }
  EXPECT_EQ(report.reflections.size(), 4U);
  for (const StoreySymmetry& reflection : report.reflections) EXPECT_TRUE(reflection.isometry.mirrored);
}

/// A round hall of straight walls, its corners rounded as files round them.
Building round_hall(int walls, double radius, double first, double rounding_m) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < walls; ++i) {
    const double angle = 2.0 * half_turn * (i + first) / walls;
    const Eigen::Vector2d p = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    corners.emplace_back((p / rounding_m).array().round() * rounding_m);
  }
  std::string text = "plan: 1\nname: hall\nstoreys: [{id: ground, elevation_m: 0, height_m: 3}]\nwalls:\n";
  std::string polygon;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    text += wall("w" + std::to_string(i), corners[i], corners[(i + 1) % corners.size()]);
    polygon += (i == 0 ? "[" : ", [") + format_number(corners[i].x()) + ", " + format_number(corners[i].y()) + "]";
  }
  return read_plan_text(text + "rooms: [{id: hall, storey: ground, polygon: [" + polygon + "]}]\n", "hall.plan.yaml");
}

TEST(Symmetry, RoundHallWithRoundedCornersHasAllItsTurns) {
  struct Hall {
    int walls;
    double radius, first, rounding_m;
  };
  for (const Hall& hall :
       {Hall{36, 8.0, 0.0, 0.001}, {24, 6.0, 0.123, 0.01}, {36, 6.0, 0.5, 0.01}, {24, 10.0, 0.123, 0.01}}) {
    const SymmetryReport report = analyse_symmetry(round_hall(hall.walls, hall.radius, hall.first, hall.rounding_m));
    const std::string which = std::to_string(hall.walls) + " walls, radius " + format_number(hall.radius);
    EXPECT_EQ(report.building.size(), static_cast<std::size_t>(hall.walls - 1)) << which;
    for (int k = 1; k < hall.walls; ++k)
      EXPECT_TRUE(has(report.building, Isometry2::turn(2.0 * half_turn * k / hall.walls, {0, 0}), 0.01, 0.02))
          << which << ", turn " << k;
  }
}

TEST(Symmetry, OneDoorLeavesOneMirrorImageAndNoTurn) {
  const SymmetryReport report =
      analyse_symmetry(box(6, 6, "openings: [{id: d, wall: s, kind: door, s_m: 3, width_m: 1}]\n" + room(6, 6)));
  for (const BuildingSymmetry& symmetry : report.building)
    EXPECT_NE(symmetry.similarity.grade, SimilarityGrade::exact) << symmetry.isometry.angle;
  const auto exact = std::count_if(report.reflections.begin(), report.reflections.end(), [](const StoreySymmetry& s) {
    return s.similarity.grade == SimilarityGrade::exact;
  });
  EXPECT_EQ(exact, 1);
}

TEST(Symmetry, HalfTurnSwapsTheTwinRooms) {
  const SymmetryReport report = analyse_symmetry(twins(0.0));
  ASSERT_EQ(report.building.size(), 1U);
  EXPECT_TRUE(has(report.building, Isometry2::turn(half_turn, {5, 3}), 1e-9, 1e-9));
  EXPECT_EQ(report.building.front().similarity.grade, SimilarityGrade::exact);
  ASSERT_EQ(report.rooms.size(), 1U);
  EXPECT_EQ(report.rooms.front().rooms.size(), 2U);
  EXPECT_NEAR(std::abs(report.rooms.front().rooms[1].isometry.angle), half_turn, 1e-9);
}

TEST(Symmetry, ShiftedDoorIsTheDeviation) {
  for (const double shift : {0.02, 0.1, 0.3, 0.5}) {
    const SymmetryReport report = analyse_symmetry(twins(shift));
    ASSERT_EQ(report.building.size(), 1U) << shift;
    const Similarity& similarity = report.building.front().similarity;
    EXPECT_EQ(similarity.grade, SimilarityGrade::near);
    // The jamb stands where the wall was or the other way round.
    EXPECT_NEAR(similarity.deviation_m, shift, 1e-6);
    ASSERT_FALSE(similarity.deviations.empty());
    EXPECT_TRUE(similarity.deviations.front().element == "s" || similarity.deviations.front().element == "n");
    EXPECT_LT(similarity.iou, 1.0);
  }
}

/// Though the walls are far from a column in mid-room: its size is what differs.
TEST(Symmetry, RoomsThatDifferByAColumnAreNearlyAlike) {
  for (const double size : {0.1, 0.2, 0.4}) {
    Building building = twins(0.0);
    const double low = 2.5 - 0.5 * size, high = 2.5 + 0.5 * size;
    Column column;
    column.id = "column";
    column.storey = 0;
    column.footprint = {{low, low}, {high, low}, {high, high}, {low, high}};
    building.columns.push_back(column);
    const SymmetryReport report = analyse_symmetry(building);
    ASSERT_EQ(report.rooms.size(), 1U) << size;
    ASSERT_EQ(report.rooms.front().rooms.size(), 2U);
    const Similarity& similarity = report.rooms.front().rooms.back().similarity;
    EXPECT_EQ(similarity.grade, SimilarityGrade::near);
    EXPECT_NEAR(similarity.deviation_m, size, 1e-6);
    ASSERT_FALSE(similarity.deviations.empty());
    EXPECT_EQ(similarity.deviations.front().element, "column");
  }
}

TEST(Symmetry, MovedBuildingHasTheConjugatedGroup) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Isometry2 move{6.0 * stream.uniform(i, 0) - 3.0,
                         100.0 * Eigen::Vector2d(stream.uniform(i, 1), stream.uniform(i, 2)), false};
    for (const Building& building : {box(6, 6, room(6, 6)), twins(0.0), twins(0.2)}) {
      const SymmetryReport here = analyse_symmetry(building), there = analyse_symmetry(moved_building(building, move));
      ASSERT_EQ(there.building.size(), here.building.size());
      for (const BuildingSymmetry& symmetry : here.building)
        EXPECT_TRUE(has(there.building, move * symmetry.isometry * move.inverse(), 1e-6, 1e-5));
      EXPECT_EQ(there.rooms.size(), here.rooms.size());
      EXPECT_EQ(there.reflections.size(), here.reflections.size());
    }
  }
}

TEST(Symmetry, FoundIsometriesAreAGroupAndKeepTheBuilding) {
  const Building building = box(6, 6, room(6, 6));
  const SymmetryReport report = analyse_symmetry(building);
  for (const BuildingSymmetry& a : report.building) {
    EXPECT_TRUE(has(report.building, a.isometry.inverse(), 1e-9, 1e-8));
    for (const BuildingSymmetry& b : report.building) {
      const Isometry2 product = a.isometry * b.isometry;
      const bool identity = std::abs(product.angle) < 1e-9 && product.t.norm() < 1e-8;
      EXPECT_TRUE(identity || has(report.building, product, 1e-9, 1e-8));
    }
    const SymmetryReport again = analyse_symmetry(moved_building(building, a.isometry));
    ASSERT_EQ(again.building.size(), report.building.size());
    for (const BuildingSymmetry& b : report.building) EXPECT_TRUE(has(again.building, b.isometry, 1e-9, 1e-8));
  }
}

/// Walls of a model have bodies of triangles; those of two walls that overlap in a corner touch each other's faces.
TEST(Symmetry, NeitherTrianglesNorTheOrderOfWallsMatter) {
  constexpr double half_m = 0.18;
  std::vector<int> order = {0, 1, 2, 3};
  int cut = 0;
  do {
    Building building = box(9, 4, room(9, 4));
    std::vector<Wall> walls;
    for (const int i : order) walls.push_back(building.walls[static_cast<std::size_t>(i)]);
    for (Wall& wall : walls) {
      const Eigen::Vector2d e = wall.direction(), n(-e.y(), e.x());
      // The long walls go through; the diagonal of each runs one way or the other.
      const double beyond = wall.length() > 5.0 ? half_m : -half_m + 0.24;
      const Eigen::Vector2d a = wall.a - beyond * e, b = wall.b + beyond * e;
      Polygon2 outline = {a - half_m * n, b - half_m * n, b + half_m * n, a + half_m * n};
      std::rotate(outline.begin(), outline.begin() + (++cut % 2), outline.end());
      wall.thickness_m = 2.0 * half_m;
      wall.body = body_over(outline, wall.z0_m, wall.z1_m);
    }
    building.walls = walls;
    const SymmetryReport report = analyse_symmetry(building);
    ASSERT_EQ(report.building.size(), 1U);
    EXPECT_EQ(report.building.front().similarity.grade, SimilarityGrade::exact);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Symmetry, RandomBuildingsHaveNone) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SymmetryReport report = analyse_symmetry(random_building(seed));
    EXPECT_TRUE(report.building.empty()) << seed;
    EXPECT_TRUE(report.storeys.empty()) << seed;
    EXPECT_TRUE(report.reflections.empty()) << seed;
  }
}

TEST(Symmetry, CopiedStoreysAreAlike) {
  const Building building = read_plan_text(
      "plan: 1\nname: tower\nstoreys:\n"
      "  - {id: ground, elevation_m: 0, height_m: 3}\n"
      "  - {id: first, elevation_m: 3.2, copy_of: ground}\n"
      "  - {id: second, elevation_m: 6.4, copy_of: ground}\nwalls:\n" +
          wall("s", {0, 0}, {9, 0}) + wall("e", {9, 0}, {9, 5}) + wall("n", {9, 5}, {0, 5}) +
          wall("w", {0, 5}, {0, 0}) + "openings: [{id: d, wall: s, kind: door, s_m: 2, width_m: 1}]\n" + room(9, 5),
      "tower.plan.yaml");
  const SymmetryReport report = analyse_symmetry(building);
  ASSERT_EQ(report.copies.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(report.copies[i].from, 0);
    EXPECT_EQ(report.copies[i].to, static_cast<int>(i) + 1);
    EXPECT_NEAR(report.copies[i].isometry.angle, 0.0, 1e-9);
    EXPECT_LT(report.copies[i].isometry.t.norm(), 1e-9);
    EXPECT_EQ(report.copies[i].similarity.grade, SimilarityGrade::exact);
  }
  ASSERT_EQ(report.rooms.size(), 1U);
  EXPECT_EQ(report.rooms.front().rooms.size(), 3U);
}

/// Two flats a half turn apart, all of whose rooms pair up.
struct TwinFlats {
  const char* file;
  std::size_t rooms;
};

void PrintTo(const TwinFlats& c, std::ostream* out) { *out << c.file; }

class SymmetryOfFlats : public testing::TestWithParam<TwinFlats> {};

TEST_P(SymmetryOfFlats, IsHalfATurn) {
  const std::string name = std::string("ifc/") + GetParam().file + ".ifc";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  const Building building = load_building(data_path(name));
  const SymmetryReport report = analyse_symmetry(building);
  const auto on = [&](const char* name) {
    return std::find_if(report.storeys.begin(), report.storeys.end(), [&](const StoreySymmetry& s) {
      return building.storeys[static_cast<std::size_t>(s.from)].name == name;
    });
  };
  const auto first = on("Level 1"), second = on("Level 2");
  ASSERT_NE(first, report.storeys.end());
  ASSERT_NE(second, report.storeys.end());
  EXPECT_NEAR(std::abs(first->isometry.angle), half_turn, 1e-4);
  EXPECT_EQ(first->similarity.grade, SimilarityGrade::exact);
  EXPECT_GT(first->similarity.iou, 0.9995);
  EXPECT_EQ(second->similarity.grade, SimilarityGrade::near);
  EXPECT_GT(second->similarity.iou, 0.99);
  EXPECT_EQ(report.building.size(), 1U);
  std::set<int> paired;
  for (const RoomClass& like : report.rooms)
    for (const auto& room : like.rooms) paired.insert(room.room);
  EXPECT_EQ(paired.size(), GetParam().rooms);
}

INSTANTIATE_TEST_SUITE_P(Own, SymmetryOfFlats, testing::Values(TwinFlats{"twin_flats", 8}),
                         [](const auto& info) { return std::string(info.param.file); });
INSTANTIATE_TEST_SUITE_P(Foreign, SymmetryOfFlats, testing::Values(TwinFlats{"duplex", 20}),
                         [](const auto& info) { return std::string(info.param.file); });

/// The file moves one door of the upper storey by 0.1 m.
TEST(Symmetry, AMovedDoorOfAFileIsTheDeviation) {
  const SymmetryReport report = analyse_symmetry(load_building(data_path("ifc/twin_flats.ifc")));
  ASSERT_EQ(report.building.size(), 1U);
  EXPECT_TRUE(has(report.building, Isometry2::turn(half_turn, {6, 4}), 1e-6, 1e-4));
  EXPECT_NEAR(report.building.front().similarity.deviation_m, 0.1, 1e-4);
}

}  // namespace
}  // namespace plumbline::bim
