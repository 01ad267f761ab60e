// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace plumbline::bim {
namespace {

constexpr double grid_m = 1e-5;

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
