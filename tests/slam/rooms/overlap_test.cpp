// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

/// Points on an ellipse at rising angles: convex, counter-clockwise.
Polygon2 random_convex(const Stream& random, std::uint64_t trial, std::uint32_t lane) {
  const auto u = [&](std::uint32_t draw) { return random.uniform(trial, lane, draw); };
  std::vector<double> angles;
  for (std::uint32_t k = 0; k < 3 + lane % 4; ++k) angles.push_back(2.0 * std::numbers::pi * u(k));
  std::sort(angles.begin(), angles.end());
  Polygon2 polygon;
  for (const double a : angles)
    polygon.emplace_back(4.0 * u(20) + (1.0 + 3.0 * u(21)) * std::cos(a),
                         4.0 * u(22) + (1.0 + 3.0 * u(23)) * std::sin(a));
  return polygon;
}

TEST(OverlapArea, IsThatOfTheExactBooleans) {
  const Stream random(6, "bim.generate");
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Polygon2 a = random_convex(random, trial, 1), b = random_convex(random, trial, 2);
    if (!is_simple(a) || !is_simple(b)) continue;
    EXPECT_TRUE(is_convex(a));
    EXPECT_NEAR(overlap_area(a, b), intersection_area(a, b), 1e-9);
    EXPECT_NEAR(overlap_area(a, a), signed_area(a), 1e-9);
  }
}

TEST(OverlapArea, OfPolygonsWithNotchesIsExactToo) {
  const Polygon2 ell = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
  const Polygon2 square = {{0.5, 0.5}, {3, 0.5}, {3, 3}, {0.5, 3}};
  EXPECT_FALSE(is_convex(ell));
  EXPECT_NEAR(overlap_area(ell, square), 1.25 + 1.0, 1e-12);
  EXPECT_EQ(overlap_area(ell, {{2, 2}, {3, 2}, {3, 3}, {2, 3}}), 0.0);
  EXPECT_EQ(overlap_area(ell, {{9, 9}, {10, 9}, {10, 10}, {9, 10}}), 0.0);
}

}  // namespace
}  // namespace plumbline::slam
