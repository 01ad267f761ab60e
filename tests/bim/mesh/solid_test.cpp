// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "bim/model/extrude.h"

namespace plumbline::bim {
namespace {

constexpr double grid_m = 1e-5;

Solid box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Polygon2 base = {low.head<2>(), {high.x(), low.y()}, high.head<2>(), {low.x(), high.y()}};
  return extrude(unite(std::vector<Polygon2>{base}), low.z(), high.z());
}

TEST(Solid, BoxIsClosedOutwardAndHasItsVolume) {
  const Solid solid = box({1, 2, 3}, {2, 4, 6});
  EXPECT_TRUE(is_closed(solid));
  EXPECT_DOUBLE_EQ(volume(solid), 6.0);
  EXPECT_EQ(solid.triangles.size(), 12U);
}

TEST(Solid, MissingOrTurnedTriangleIsNotClosed) {
  Solid open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  EXPECT_FALSE(is_closed(open));
  Solid turned = box({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(is_closed(turned));
  EXPECT_FALSE(is_closed({}));
}

TEST(Solid, CanonicalFormForgetsTheOrder) {
  const Solid solid = box({0, 0, 0}, {1, 2, 3});
  Solid shuffled = solid;
  std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
  std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
  const int last = static_cast<int>(solid.vertices.size()) - 1;
  for (Eigen::Vector3i& t : shuffled.triangles) t = Eigen::Vector3i(last - t[1], last - t[2], last - t[0]);
  const Solid a = canonical(solid, 1e-6), b = canonical(shuffled, 1e-6);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_TRUE(is_closed(a));
  EXPECT_DOUBLE_EQ(volume(a), 6.0);
}

TEST(Solid, WeldingClosesATriangleSoup) {
  const Solid solid = box({0, 0, 0}, {1, 1, 1});
  Solid soup;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int i = 0; i < 3; ++i) soup.vertices.push_back(solid.vertices[static_cast<std::size_t>(t[i])]);
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_FALSE(is_closed(soup));
  EXPECT_TRUE(is_closed(welded(soup, 1e-5)));
  EXPECT_EQ(welded(soup, 1e-5).vertices.size(), 8U);
}

/// A tetrahedron with a vertex at a share of its edge 0-1 that only one of the two faces there knows; a triangle of no
/// height closes the other.
Solid with_sliver(double share, double height_m) {
  Solid solid;
  solid.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {4 * share, -height_m, 0}};
  // Below: 0 2 1; in front: 0 1 3, split into 0 4 3 and 4 1 3.
  solid.triangles = {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 1, 4}};
  return solid;
}

double least_height(const Solid& solid) {
  double least = 1e9;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const auto p = [&](int k) { return solid.vertices[static_cast<std::size_t>(t[k % 3])]; };
    const double twice_area = (p(1) - p(0)).cross(p(2) - p(0)).norm();
    for (int k = 0; k < 3; ++k) least = std::min(least, twice_area / (p(k + 1) - p(k)).norm());
  }
  return least;
}

TEST(WithoutSlivers, TurnsThemOverTheirLongestSide) {
  for (const double share : {0.1, 0.25, 0.5, 0.9}) {
    for (const double height_m : {0.0, 0.5 * grid_m}) {
      const Solid solid = with_sliver(share, height_m);
      ASSERT_TRUE(is_closed(solid));
      ASSERT_LT(least_height(solid), grid_m);
      const Solid clean = without_slivers(solid, grid_m);
      EXPECT_TRUE(is_closed(clean));
      EXPECT_EQ(clean.triangles.size(), solid.triangles.size());
      EXPECT_GT(least_height(clean), 0.1) << share;
      EXPECT_NEAR(volume(clean), 4.0, 1e-4);
    }
  }
}

TEST(WithoutSlivers, LeavesSoundTrianglesAlone) {
  const Solid solid = with_sliver(0.5, 0.5);
  EXPECT_EQ(without_slivers(solid, grid_m).triangles, solid.triangles);
}

TEST(Widened, MovesAllFacesOutward) {
  Solid prism;
  prism.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 1}, {3, 0, 1}, {0, 4, 1}};
  prism.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const Solid wide = widened(prism, 0.1);
  EXPECT_TRUE(is_closed(wide));
  EXPECT_NEAR(volume(wide), 6.0 * 1.1 * 1.1 * 1.2, 1e-9);  // the inscribed circle of the outline has a radius of 1
  EXPECT_TRUE(widened({}, 0.1).vertices.empty());
}

}  // namespace
}  // namespace plumbline::bim
