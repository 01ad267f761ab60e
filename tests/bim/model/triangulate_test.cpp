// SPDX-License-Identifier: Apache-2.0
#include "bim/model/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

double area_of(const FlatMesh& mesh, const FlatTriangle& t) {
  const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(t.points[i])]; };
  return signed_area({p(0), p(1), p(2)});
}

/// A facade with a regular grid of windows: nearly every quadrilateral of its points lies on one circle.
Region2 facade(int columns, int rows) {
  std::vector<Polygon2> windows;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) windows.push_back(rectangle(2 * i + 1, 2 * j + 1, 2 * i + 2, 2 * j + 2));
  return subtract(unite(std::vector<Polygon2>{rectangle(0, 0, 2 * columns + 1, 2 * rows + 1)}), windows);
}

void expect_sound(const FlatMesh& mesh, double area) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const FlatTriangle& triangle = mesh.triangles[t];
    EXPECT_GT(area_of(mesh, triangle), 0.0);
    sum += area_of(mesh, triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangle.neighbours[i] < 0) continue;
      const FlatTriangle& other = mesh.triangles[static_cast<std::size_t>(triangle.neighbours[i])];
      const auto back = std::find(other.neighbours.begin(), other.neighbours.end(), static_cast<int>(t));
      ASSERT_NE(back, other.neighbours.end());
      const auto j = static_cast<std::size_t>(back - other.neighbours.begin());
      EXPECT_EQ(triangle.points[(i + 1) % 3], other.points[(j + 2) % 3]);
      EXPECT_EQ(triangle.points[(i + 2) % 3], other.points[(j + 1) % 3]);
    }
  }
  EXPECT_NEAR(sum, area, 1e-9);
}

TEST(Triangulate, CoversTheRegionWithMatchingNeighbours) {
  expect_sound(triangulate(facade(5, 3)), 11.0 * 7.0 - 15.0);
  EXPECT_TRUE(triangulate({}).triangles.empty());
}

TEST(Triangulate, RepeatedPointsCountOnce) {
  const Polygon2 doubled = {{0, 0}, {0, 0}, {3, 0}, {3, 2}, {3, 2}, {3, 2}, {0, 2}, {0, 0}};
  const Polygon2 hole = {{1, 1}, {1, 1.5}, {1, 1.5}, {2, 1.5}};
  const FlatMesh mesh = triangulate({PolygonWithHoles2{doubled, {hole}}});
  expect_sound(mesh, 6.0 - 0.25);
  const FlatMesh plain = triangulate({PolygonWithHoles2{rectangle(0, 0, 3, 2), {{{1, 1}, {1, 1.5}, {2, 1.5}}}}});
  ASSERT_EQ(mesh.triangles.size(), plain.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    EXPECT_EQ(mesh.triangles[t].points, plain.triangles[t].points);
  EXPECT_TRUE(triangulate({PolygonWithHoles2{{{1, 1}, {1, 1}, {1, 1}}, {}}}).triangles.empty());
}

TEST(Triangulate, RandomRegions) {
  const Stream stream(10, "bim.generate");
  for (std::uint64_t tick = 0; tick < 40; ++tick) {
    std::vector<Polygon2> cuts;
    for (std::uint32_t i = 0; i < 6; ++i) {
      const auto draw = [&](std::uint32_t k) { return stream.uniform(tick, i, k); };
      const double x = std::floor(draw(0) * 10), y = std::floor(draw(1) * 6);
      cuts.push_back(rectangle(x, y, x + 1 + std::floor(draw(2) * 3), y + 1 + std::floor(draw(3) * 2)));
    }
    const Region2 region = subtract(unite(std::vector<Polygon2>{rectangle(0, 0, 10, 6)}), cuts);
    expect_sound(triangulate(region), area(region));
  }
}

TEST(Triangulate, PointsOnOneCircleFanOutFromTheLowest) {
  // Twelve grid points at distance 5.
  const Polygon2 ring = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                         {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
  const FlatMesh mesh = triangulate(unite(std::vector<Polygon2>{ring}));
  ASSERT_EQ(mesh.triangles.size(), 10U);
  EXPECT_EQ(mesh.points[0], Eigen::Vector2d(-5, 0));
  for (const FlatTriangle& t : mesh.triangles) EXPECT_EQ(t.points[0], 0);
}

TEST(Triangulate, DoesNotDependOnWhatRanBefore) {
  const Region2 region = facade(12, 8);
  const FlatMesh first = triangulate(region);
  for (int round = 0; round < 5; ++round) {
    // Other sizes leave the heap in another state each time.
    std::vector<std::unique_ptr<std::vector<double>>> kept;
    for (int i = 0; i < 50; ++i)
      kept.push_back(std::make_unique<std::vector<double>>(static_cast<std::size_t>(17 * i + 31 * round + 1)));
    (void)triangulate(facade(3 + round, 7 - round));
    for (std::size_t i = 0; i < kept.size(); i += 2) kept[i].reset();
    const FlatMesh again = triangulate(region);
    ASSERT_EQ(again.triangles.size(), first.triangles.size());
    EXPECT_EQ(again.points, first.points);
    for (std::size_t t = 0; t < first.triangles.size(); ++t)
      EXPECT_EQ(again.triangles[t].points, first.triangles[t].points);
  }
}

}  // namespace
}  // namespace plumbline::bim
