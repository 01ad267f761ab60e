// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/symmetry_bodies.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/geometry/polygon_boolean.h"
#include "bim/random/stream.h"
#include "bim/symmetry/faces.h"

namespace plumbline::bim {
namespace {

Polygon2 rectangle(const Eigen::Vector2d& at, double length, double width, double angle) {
  const Isometry2 g = Isometry2::taking(angle, false, Eigen::Vector2d::Zero(), at);
  return g * Polygon2{{0.0, 0.0}, {length, 0.0}, {length, width}, {0.0, width}};
}

std::vector<BodyPrism> draw(std::uint64_t seed, int count) {
  const Stream stream(seed, "bim.generate");
  std::vector<BodyPrism> prisms;
  for (int i = 0; i < count; ++i) {
    const auto u = [&](std::uint32_t lane) { return stream.uniform(static_cast<std::uint64_t>(i), lane); };
    prisms.push_back({rectangle({4.0 * u(0), 4.0 * u(1)}, 0.5 + 3.0 * u(2), 0.1 + u(3), 2.0 * std::numbers::pi * u(4)),
                      0.0, 2.0, i});
  }
  return prisms;
}

TEST(SymmetryBodies, WithoutOverlapsFillTheUnion) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<BodyPrism> prisms = draw(seed, 8);
    std::vector<Polygon2> outlines;
    for (const BodyPrism& prism : prisms) outlines.push_back(prism.outline);
    // The exact boolean rounds to its grid: 0.1 mm along at most 40 m of outline.
    EXPECT_NEAR(volume(without_overlaps(prisms)), 2.0 * area(unite(outlines)), 2.0 * 40.0 * boolean_grid_m);
  }
}

TEST(SymmetryBodies, OverlapsInHeightCountOnce) {
  const Polygon2 square = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  EXPECT_NEAR(volume(without_overlaps({{square, 0.0, 2.0, 0}, {square, 1.0, 3.0, 1}})), 3.0, 1e-12);
}

TEST(SymmetryBodies, SurfacesGoRoundTheUnionOnce) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<BodyPrism> prisms = draw(seed, 8);
    std::vector<Polygon2> outlines;
    for (const BodyPrism& prism : prisms) outlines.push_back(prism.outline);
    double perimeter = 0.0, surface = 0.0;
    for (const PolygonWithHoles2& piece : unite(outlines)) {
      std::vector<Polygon2> rings = piece.holes;
      rings.push_back(piece.outer);
      for (const Polygon2& ring : rings)
        for (std::size_t k = 0; k < ring.size(); ++k) perimeter += (ring[(k + 1) % ring.size()] - ring[k]).norm();
    }
    for (const SurfaceRect& rect : visible_surfaces(prisms, 1e-6, {1e-6, 1e-6})) surface += rect.area();
    // Slivers and touching depth cost micrometres at each of at most some hundred corners.
    EXPECT_NEAR(surface, 2.0 * perimeter, 0.01) << seed;
  }
}

TEST(SymmetryBodies, TouchingBodiesHaveNoSurfaceBetweenThem) {
  const Polygon2 left = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  const Polygon2 right = {{1.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}};
  double surface = 0.0;
  for (const SurfaceRect& rect : visible_surfaces({{left, 0.0, 1.0, 0}, {right, 0.0, 1.0, 1}}, 1e-6, {1e-6, 1e-6}))
    surface += rect.area();
  EXPECT_NEAR(surface, 6.0, 1e-4);
}

/// However a convex area is cut into triangles.
TEST(SymmetryBodies, PartsOfAConvexAreaAreThatArea) {
  const Eigen::Vector2d a(0.0, 0.0), b(4.0, 0.0), c(4.0, 0.2), d(0.0, 0.2), middle(2.0, 0.2);
  for (const std::vector<Polygon2>& pieces :
       {std::vector<Polygon2>{{a, b, c}, {a, c, d}}, std::vector<Polygon2>{{a, b, d}, {b, c, d}},
        std::vector<Polygon2>{{a, b, middle}, {b, c, middle}, {a, middle, d}}}) {
    const std::vector<Polygon2> parts = convex_parts(pieces);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts.front().size(), 4U);
    EXPECT_NEAR(signed_area(parts.front()), 0.8, 1e-12);
  }
}

TEST(SymmetryBodies, PartsOfAnAngleAreConvex) {
  const Eigen::Vector2d a(0.0, 0.0), b(3.0, 0.0), c(3.0, 1.0), d(1.0, 1.0), e(1.0, 3.0), f(0.0, 3.0);
  const std::vector<Polygon2> parts = convex_parts({{a, b, d}, {b, c, d}, {a, d, f}, {d, e, f}});
  EXPECT_LE(parts.size(), 3U);
  double sum = 0.0;
  for (const Polygon2& part : parts) sum += signed_area(part);
  EXPECT_NEAR(sum, 5.0, 1e-12);
}

}  // namespace
}  // namespace plumbline::bim
