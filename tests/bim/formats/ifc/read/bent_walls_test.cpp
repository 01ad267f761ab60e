// SPDX-License-Identifier: Apache-2.0
// Walls whose bodies are not rectangles along their reference lines: turned, rings, bent, curved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/mesh.h"
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

}  // namespace
}  // namespace plumbline::bim
