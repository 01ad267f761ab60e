// SPDX-License-Identifier: Apache-2.0
// Walls whose bodies are not rectangles along their reference lines: turned, rings, bent, curved.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
#include "bim/model/extrude.h"
#include "bim/model/odd_size.h"
#include "tests/bim/formats/ifc/read/reading.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {
namespace {

/// A wall without Axis, its body in the coordinates of the storey.
std::string plain_wall(Sketch& sketch, const Polygon2& outline) {
  return sketch.element("IFCWALL", sketch.shape(sketch.prism(outline, 0, 3)), "$,$");
}

int kinds(const Building& building, OpeningKind kind) {
  return static_cast<int>(std::count_if(building.openings.begin(), building.openings.end(),
                                        [&](const Opening& opening) { return opening.kind == kind; }));
}

/// A rectangle turned about the origin.
Polygon2 turned(double x0, double y0, double x1, double y1, double angle) {
  Polygon2 outline = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  for (Eigen::Vector2d& p : outline) p = Eigen::Rotation2Dd(angle) * p;
  return outline;
}

/// Three rooms and two doors, 10 by 8 m, all bodies in the coordinates of the storey.
Building three_rooms(double angle) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab(turned(0, 0, 10, 8, angle), -0.2, 0);
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    return plain_wall(sketch, turned(x0, y0, x1, y1, angle));
  };
  const auto door = [&](const std::string& host, double x0, double y0, double x1, double y1) {
    sketch.door(sketch.opening(host, sketch.prism(turned(x0, y0, x1, y1, angle), 0, 2.1)));
  };
  wall(-0.1, -0.1, 10.1, 0.1);
  wall(-0.1, 7.9, 10.1, 8.1);
  wall(-0.1, 0.1, 0.1, 7.9);
  wall(9.9, 0.1, 10.1, 7.9);
  const std::string across = wall(0.1, 4.9, 9.9, 5.1), along = wall(4.9, 0.1, 5.1, 4.9);
  door(across, 1.5, 4.8, 2.5, 5.2);
  door(along, 4.8, 2, 5.2, 3);
  return read(sketch);
}

/// Volume of all walls as they are built, m^3.
double volume_of_walls(const Building& building) {
  double sum = 0.0;
  for (const MeshElement& element : build_mesh(building).elements)
    if (element.kind == ElementKind::wall) sum += element.volume_m3;
  return sum;
}

TEST(BentWalls, WithoutAxisLieAlongTheirBodiesHoweverTheyAreTurned) {
  const Building straight = three_rooms(0.0);
  ASSERT_EQ(straight.rooms.size(), 3u);
  for (const double degrees : {37.0, 45.0, 90.0, -20.0}) {
    const Building building = three_rooms(degrees * std::numbers::pi / 180.0);
    ASSERT_EQ(building.walls.size(), straight.walls.size());
    for (std::size_t i = 0; i < building.walls.size(); ++i) {
      EXPECT_NEAR(building.walls[i].thickness_m, 0.2, 1e-3) << degrees;
      EXPECT_NEAR(building.walls[i].length(), straight.walls[i].length(), 1e-3) << degrees;
    }
    EXPECT_EQ(building.openings.size(), 2u) << degrees;
    ASSERT_EQ(building.rooms.size(), 3u) << degrees;
    std::multiset<std::size_t> walls, walls_of_straight;
    for (const Room& room : building.rooms) walls.insert(room.walls.size());
    for (const Room& room : straight.rooms) walls_of_straight.insert(room.walls.size());
    EXPECT_EQ(walls, walls_of_straight) << degrees;
    for (const Opening& door : building.openings) {
      EXPECT_GE(std::min(door.rooms[0], door.rooms[1]), 0) << degrees;
      EXPECT_NE(door.rooms[0], door.rooms[1]) << degrees;
    }
    EXPECT_NEAR(volume_of_walls(building), volume_of_walls(straight), 0.02) << degrees;
  }
}

TEST(BentWalls, ARingBecomesItsFourSides) {
  for (const double angle : {0.0, 0.6}) {
    Sketch sketch;
    sketch.storey(0);
    sketch.slab(turned(0, 0, 10, 8, angle), -0.2, 0);
    const auto profile =
        sketch.add("IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$," + sketch.polyline(turned(-0.1, -0.1, 10.1, 8.1, angle)) +
                   ",(" + sketch.polyline(turned(0.1, 0.1, 9.9, 7.9, angle)) + "))");
    const std::string ring = sketch.element("IFCWALL", sketch.shape(sketch.extruded(profile, 0, 3)), "$,$");
    sketch.door(sketch.opening(ring, sketch.prism(turned(2, -0.2, 3, 0.2, angle), 0, 2.1)));
    const std::string between = plain_wall(sketch, turned(0.1, 4.9, 9.9, 5.1, angle));
    sketch.door(sketch.opening(between, sketch.prism(turned(6, 4.8, 7, 5.2, angle), 0, 2.1)));
    const Building building = read(sketch);
    EXPECT_EQ(building.walls.size(), 5u) << angle;
    for (const Wall& wall : building.walls) EXPECT_NEAR(wall.thickness_m, 0.2, 1e-3) << wall.id;
    EXPECT_EQ(count(building, "bent_wall"), 1);
    EXPECT_EQ(building.openings.size(), 2u);
    ASSERT_EQ(building.rooms.size(), 2u);
    for (const Room& room : building.rooms) EXPECT_EQ(room.walls.size(), 4u);
    const double metres2 = 10.2 * 8.2 - 9.8 * 7.8 + 9.8 * 0.2;
    EXPECT_NEAR(volume_of_walls(building), metres2 * 3 - 2 * 2.1 * 0.2, 0.02);
  }
}

/// A ring of four sides whose surface is closed but touches itself: the last side ends on the first.
std::string ring_with_a_seam(Sketch& sketch) {
  const Polygon2 outer = {{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0.2}};
  const Polygon2 inner = {{0, 0.2}, {3.8, 0.2}, {3.8, 2.8}, {0.2, 2.8}, {0.2, 0.2}};
  std::string points, faces;
  for (const Polygon2& outline : {outer, inner})
    for (const double z : {0.0, 3.0})
      for (const Eigen::Vector2d& p : outline)
        points += (points.empty() ? "(" : ",(") + Sketch::n(p.x()) + "," + Sketch::n(p.y()) + "," + Sketch::n(z) + ")";
  const auto face = [&](int a, int b, int c, int d) {
    faces += (faces.empty() ? "" : ",") +
             sketch.add("IFCINDEXEDPOLYGONALFACE((" + std::to_string(a) + "," + std::to_string(b) + "," +
                        std::to_string(c) + "," + std::to_string(d) + "))");
  };
  for (int i = 1; i <= 4; ++i) {
    face(i + 6, i + 5, i, i + 1);
    face(i + 16, i + 11, i + 10, i + 15);
    face(i + 1, i, i + 10, i + 11);
    face(i + 5, i + 6, i + 16, i + 15);
  }
  face(1, 6, 16, 11);
  face(10, 5, 15, 20);
  const std::string list = sketch.add("IFCCARTESIANPOINTLIST3D((" + points + "))");
  return sketch.add("IFCPOLYGONALFACESET(" + list + ",$,(" + faces + "),$)");
}

TEST(BentWalls, ARingWithASeamBecomesItsFourSides) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, -0.2, 0);
  sketch.element("IFCWALL", sketch.shape(ring_with_a_seam(sketch)), "$,$");
  const Building building = read(sketch);
  ASSERT_EQ(building.walls.size(), 4u);
  for (const Wall& wall : building.walls) EXPECT_NEAR(wall.thickness_m, 0.2, 1e-3) << wall.id;
  EXPECT_NEAR(volume_of_walls(building), (4 * 3 - 3.6 * 2.6) * 3, 1e-3);
  ASSERT_EQ(building.rooms.size(), 1u);
  EXPECT_EQ(building.rooms.front().walls.size(), 4u);
}

TEST(BentWalls, CornersAndBranchesBecomeStraightWalls) {
  const Polygon2 corner = {{0, 0}, {6, 0}, {6, 0.2}, {0.2, 0.2}, {0.2, 5}, {0, 5}};
  const Polygon2 branch = {{0, 0}, {6, 0}, {6, 0.2}, {3.1, 0.2}, {3.1, 4}, {2.9, 4}, {2.9, 0.2}, {0, 0.2}};
  for (const Polygon2& outline : {corner, branch}) {
    for (const bool sloping : {false, true}) {
      Sketch sketch;
      sketch.storey(0);
      sketch.slab({{0, 0}, {6, 0}, {6, 5}, {0, 5}}, -0.2, 0);
      std::string body = sketch.prism(outline, 0, 3);
      if (sloping)
        body = sketch.difference(body, sketch.half_space(sketch.frame(0, 0, 2.0, "-0.1,0.,1.", "1.,0.,0.1")));
      sketch.element("IFCWALL", sketch.shape(body), "$,$");
      const Building building = read(sketch);
      ASSERT_EQ(building.walls.size(), 2u) << sloping;
      EXPECT_NEAR(building.walls[0].length(), 6.0, 1e-3);
      EXPECT_NEAR(building.walls[0].thickness_m, 0.2, 1e-3);
      EXPECT_NEAR(building.walls[1].thickness_m, 0.2, 1e-3);
      EXPECT_NE(building.walls[0].id, building.walls[1].id);
      if (sloping) {
        EXPECT_NEAR(building.walls[0].z1_m, 2.6, 1e-3);
      } else {
        EXPECT_NEAR(volume_of_walls(building), signed_area(outline) * 3, 0.01);
      }
    }
  }
}

TEST(WallsOfLayers, ThatTouchAreOneBody) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {6, 0}, {6, 5}, {0, 5}}, -0.2, 0);
  const std::string wall = sketch.element("IFCWALL", "$", "$,$");
  std::string layers;
  for (const auto& [y0, y1] : {std::pair(0.0, 0.05), std::pair(0.05, 0.25), std::pair(0.25, 0.3)})
    layers += (layers.empty() ? "" : ",") +
              sketch.rooted("IFCBUILDINGELEMENTPART",
                            "'layer',$,$," + sketch.add("IFCLOCALPLACEMENT($," + sketch.frame(0, 0, 0) + ")") + "," +
                                sketch.shape(sketch.box(0, y0, 0, 6, y1, 3)) + ",$,$");
  sketch.rooted("IFCRELAGGREGATES", "$,$," + wall + ",(" + layers + ")");
  sketch.door(sketch.opening(wall, sketch.box(2, -0.1, 0, 3, 0.4, 2)));
  const Building building = read(sketch);
  ASSERT_EQ(building.walls.size(), 1u);
  EXPECT_NEAR(building.walls.front().thickness_m, 0.3, 1e-6);
  const BuildingMesh mesh = build_mesh(building);
  EXPECT_TRUE(mesh.elements.front().closed);
  EXPECT_NEAR(mesh.elements.front().volume_m3, (6.0 * 3.0 - 2.0) * 0.3, 1e-3);
}

TEST(BentWalls, GablesAreStraight) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{0, 0}, {8, 0}, {8, 5}, {0, 5}}, -0.2, 0);
  std::string body = sketch.box(0, 0, 0, 8, 0.2, 4);
  for (const char* normal : {"-1.,0.,1.", "1.,0.,1."})
    body = sketch.difference(body, sketch.half_space(sketch.frame(4, 0, 4, normal, "0.,1.,0.")));
  sketch.element("IFCWALL", sketch.shape(body), "$,$");
  const Building building = read(sketch);
  ASSERT_EQ(building.walls.size(), 1u);
  EXPECT_NEAR(volume_of_walls(building), 0.5 * 8 * 4 * 0.2, 0.01);
  EXPECT_EQ(count(building, "bent_wall"), 0);
}

TEST(BentWalls, AreAsLargeAsTheirBodies) {
  Building building;
  Wall& wall = building.walls.emplace_back();
  wall.b = {8e5, 0.0};
  wall.body = extrude(unite(std::vector<Polygon2>{{{0, 0}, {8, 0}, {8, 0.2}, {0, 0.2}}}), 0, 3);
  EXPECT_EQ(odd_size(building), "");
}

/// A half ring of facets around the origin, on the side of positive x.
Polygon2 half_ring(double inner, double outer) {
  Polygon2 outline;
  constexpr int facets = 24;
  for (int i = 0; i <= 2 * facets + 1; ++i) {
    const double radius = i <= facets ? outer : inner;
    const double angle = std::numbers::pi * ((i <= facets ? i : 2 * facets + 1 - i) / double{facets} - 0.5);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

TEST(BentWalls, ADoorWithinACurvedWallsBoxLeavesTheCurvedWallWhole) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-10, -5}, {5, -5}, {5, 5}, {-10, 5}}, -0.2, 0);
  plain_wall(sketch, half_ring(3.9, 4.1));
  for (const double y : {-4.0, 4.0}) sketch.wall(-8, y, 8, 0.2, 3);
  sketch.wall(-8, -4, 8, 0.2, 3, true);
  const std::string screen = sketch.wall(0.8, -3.8, 7.6, 0.1, 3, true);
  sketch.door(sketch.opening(screen, sketch.box(0.6, -0.6, 0, 1.0, 0.6, 2.2)));
  const Building building = read(sketch);
  EXPECT_EQ(kinds(building, OpeningKind::door), 1);
  EXPECT_EQ(kinds(building, OpeningKind::opening_void), 0);
  EXPECT_EQ(count(building, "walls_overlap"), 0);
}

TEST(BentWalls, ADoorOfACurvedWallLeavesTheWallsBeforeItWhole) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-10, -5}, {5, -5}, {5, 5}, {-10, 5}}, -0.2, 0);
  const std::string apse = plain_wall(sketch, half_ring(3.9, 4.1));
  sketch.door(sketch.opening(apse, sketch.box(3.6, -0.6, 0, 4.4, 0.6, 2.2)));
  sketch.wall(0.8, -3.8, 7.6, 0.1, 3, true);
  EXPECT_EQ(kinds(read(sketch), OpeningKind::opening_void), 0);
}

TEST(BentWalls, ADoorInACurvedWallBehindAnotherOpensBoth) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-10, -5}, {5, -5}, {5, 5}, {-10, 5}}, -0.2, 0);
  plain_wall(sketch, half_ring(3.9, 4.1));
  const std::string straight = sketch.wall(4.0, -2, 4, 0.3, 3, true);
  sketch.door(sketch.opening(straight, sketch.box(3.6, -0.6, 0, 4.4, 0.6, 2.2)));
  const Building building = read(sketch);
  const auto behind = std::find_if(building.openings.begin(), building.openings.end(),
                                   [](const Opening& opening) { return opening.kind == OpeningKind::opening_void; });
  ASSERT_NE(behind, building.openings.end());
  EXPECT_EQ(count(building, "walls_overlap"), 1);
  const BuildingMesh mesh = build_mesh(building);
  const auto curved = std::find_if(mesh.elements.begin(), mesh.elements.end(), [&](const MeshElement& element) {
    return element.kind == ElementKind::wall && element.index == behind->wall;
  });
  ASSERT_NE(curved, mesh.elements.end());
  const double whole = 12.0 * std::sin(std::numbers::pi / 24) * (4.1 * 4.1 - 3.9 * 3.9) * 3.0;
  EXPECT_NEAR(curved->volume_m3, whole - 1.2 * 2.2 * 0.2, 0.05) << "only where the door is";
}

// Such an axis was believed: the rectangle along it stood across the rooms and in the doors.
TEST(BentWalls, AStraightBodyGoesBeforeAnAxisThatContradictsIt) {
  Sketch sketch;
  sketch.storey(0);
  sketch.slab({{-1, -1}, {9, -1}, {9, 5}, {-1, 5}}, -0.2, 0);
  sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, 0, 0, 0.2, 4, 3), 1.0), "$,$");
  sketch.element("IFCWALL", sketch.wall_shape(sketch.box(0, -0.1, 0, 3, 0.1, 3), 8.0), "$,$");
  const Building building = read(sketch);
  ASSERT_EQ(building.walls.size(), 2u);
  EXPECT_EQ(count(building, "bent_wall"), 0);
  EXPECT_EQ(count(building, "no_axis"), 2);
  EXPECT_NEAR(building.walls[0].length(), 4.0, 1e-6);
  EXPECT_NEAR(building.walls[1].length(), 3.0, 1e-6);
  for (const Wall& wall : building.walls) EXPECT_NEAR(wall.thickness_m, 0.2, 1e-6);
}

}  // namespace
}  // namespace plumbline::bim
