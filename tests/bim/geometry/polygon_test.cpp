// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/bim/geometry/rectangle.h"

namespace plumbline {
namespace {

const Polygon2 l_shape = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};

/// Star-shaped about centre (at least 5 corners, so that no gap reaches 180 degrees), hence simple; counter-clockwise.
Polygon2 random_star(const Stream& stream, std::uint64_t tick, const Eigen::Vector2d& centre) {
  Polygon2 polygon;
  const int n = 5 + static_cast<int>(stream.uniform(tick, 0) * 7.0);
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.8 * stream.uniform(tick, 1, static_cast<unsigned>(i))) / n;
    const double radius = 0.5 + 2.0 * stream.uniform(tick, 2, static_cast<unsigned>(i));
    polygon.push_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

TEST(Polygon, AreaAndCentroidOfAnLShape) {
  EXPECT_DOUBLE_EQ(signed_area(l_shape), 6.0);
  const Eigen::Vector2d expected((4.0 * 2.0 + 2.0 * 0.5) / 6.0, (4.0 * 0.5 + 2.0 * 2.0) / 6.0);
  EXPECT_NEAR((centroid(l_shape) - expected).norm(), 0.0, 1e-12);
}

TEST(Polygon, AreaChangesSignWithOrientation) {
  Polygon2 reversed = l_shape;
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_DOUBLE_EQ(signed_area(reversed), -6.0);
  EXPECT_NEAR((centroid(reversed) - centroid(l_shape)).norm(), 0.0, 1e-12);
}

TEST(Polygon, ContainsItsBoundaryAndNothingBeyond) {
  EXPECT_TRUE(contains(l_shape, {0.5, 2.0}));
  EXPECT_TRUE(contains(l_shape, {1.0, 1.0}));
  EXPECT_TRUE(contains(l_shape, {1.0, 2.0}));
  EXPECT_TRUE(contains(l_shape, {0.0, 0.0}));
  EXPECT_FALSE(contains(l_shape, {1.0 + 1e-6, 2.0}));
  EXPECT_FALSE(contains(l_shape, {-1e-6, 1.0}));
  EXPECT_FALSE(contains(l_shape, {-1.0, 3.0}));
}

TEST(Polygon, ContainsAgreesWithDistanceAtRandomPoints) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    const Polygon2 star = random_star(stream, tick, {0.0, 0.0});
    for (unsigned k = 0; k < 20; ++k) {
      const double s = stream.uniform(tick, 3, k);
      const std::size_t i = k % star.size();
      const Eigen::Vector2d on_edge = (1.0 - s) * star[i] + s * star[(i + 1) % star.size()];
      EXPECT_LT(boundary_distance(star, on_edge), 1e-12);
      // Stars are seen whole from the origin: scaling a boundary point down enters, scaling it up leaves.
      EXPECT_TRUE(contains(star, 0.999 * on_edge));
      EXPECT_FALSE(contains(star, 1.001 * on_edge));
    }
  }
}

TEST(Polygon, SegmentDistanceAlongAndBeyond) {
  EXPECT_DOUBLE_EQ(segment_distance({0, 0}, {2, 0}, {1, 3}), 3.0);
  EXPECT_DOUBLE_EQ(segment_distance({0, 0}, {2, 0}, {5, 4}), 5.0);
  EXPECT_DOUBLE_EQ(segment_distance({1, 1}, {1, 1}, {4, 5}), 5.0);
}

TEST(Polygon, RefusesWhatIsNotSimple) {
  EXPECT_TRUE(is_simple(l_shape));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 2}, {2, 0}, {0, 2}}));          // bow tie
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));  // touches its own edge
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {1, 0}, {1, 1}}));          // folds back
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {2, 0}}));                  // flat
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, 0}, {1, 1}}));          // repeated vertex
  EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}));   // straight vertex
}

TEST(Polygon, InteriorPointOfASquareIsItsCentre) {
  const Eigen::Vector2d p = interior_point(rectangle(1, 2, 3, 4));
  EXPECT_NEAR((p - Eigen::Vector2d(2, 3)).norm(), 0.0, 1e-6);
}

TEST(Polygon, InteriorPointIsInsideAtRandom) {
  const Stream stream(2, "bim.generate");
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const Polygon2 star = random_star(stream, tick, {5.0, -7.0});
    EXPECT_TRUE(contains(star, interior_point(star)));
    EXPECT_GT(boundary_distance(star, interior_point(star)), 0.05);
  }
}

TEST(Polygon, IntersectionAreaOfRectangles) {
  EXPECT_DOUBLE_EQ(intersection_area(rectangle(0, 0, 2, 2), rectangle(1, 1, 5, 3)), 1.0);
  EXPECT_DOUBLE_EQ(intersection_area(rectangle(0, 0, 2, 2), rectangle(2, 0, 3, 2)), 0.0);
  EXPECT_DOUBLE_EQ(intersection_area(l_shape, rectangle(-1, -1, 9, 9)), 6.0);
  EXPECT_DOUBLE_EQ(intersection_area(l_shape, rectangle(2, 2, 3, 3)), 0.0);
  Polygon2 clockwise = l_shape;
  std::reverse(clockwise.begin(), clockwise.end());
  EXPECT_DOUBLE_EQ(intersection_area(clockwise, rectangle(0, 0, 1, 9)), 3.0);
}

TEST(Polygon, IntersectionAreaLaws) {
  const Stream stream(3, "bim.generate");
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    const Polygon2 a = random_star(stream, 2 * tick, {0.0, 0.0});
    const Polygon2 b = random_star(stream, 2 * tick + 1, {stream.uniform(tick, 4) * 3.0, stream.uniform(tick, 5)});
    const double both = intersection_area(a, b);
    EXPECT_EQ(both, intersection_area(b, a));
    EXPECT_LE(both, std::min(signed_area(a), signed_area(b)) + 1e-12);
    // Rounding of the double area only; the boolean itself is exact.
    EXPECT_NEAR(intersection_area(a, a), signed_area(a), 1e-12);
  }
}

TEST(Polygon, IntersectionAreaRefusesABowTie) {
  EXPECT_THROW((void)intersection_area({{0, 0}, {2, 2}, {2, 0}, {0, 2}}, l_shape), InternalError);
}

}  // namespace
}  // namespace plumbline
