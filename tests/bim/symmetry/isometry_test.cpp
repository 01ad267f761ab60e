// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/isometry.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

constexpr double rounding = 1e-12;

Isometry2 draw(const Stream& stream, std::uint64_t tick) {
  const auto u = [&](std::uint32_t lane) { return 2.0 * stream.uniform(tick, lane) - 1.0; };
  return {u(0) * std::numbers::pi, 10.0 * Eigen::Vector2d(u(1), u(2)), u(3) > 0.0};
}

TEST(Isometry2, InverseAndProductAgreeWithPoints) {
  const Stream stream(5, "bim.generate");
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Isometry2 g = draw(stream, 2 * i), h = draw(stream, 2 * i + 1);
    const Eigen::Vector2d p(3.0, -1.5), q(-2.0, 0.25);
    EXPECT_LT((g.inverse() * (g * p) - p).norm(), 20 * rounding);
    EXPECT_LT(((g * h) * p - g * (h * p)).norm(), 20 * rounding);
    EXPECT_NEAR((g * p - g * q).norm(), (p - q).norm(), 20 * rounding);
    EXPECT_EQ((g * h).mirrored, g.mirrored != h.mirrored);
  }
}

TEST(Isometry2, LeavesItsCentreAndTakesPointToPoint) {
  const Stream stream(6, "bim.generate");
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Eigen::Vector2d about(4.0 * stream.uniform(i, 0), -3.0 * stream.uniform(i, 1));
    const double angle = 0.1 + 6.0 * stream.uniform(i, 2);
    const Isometry2 g = Isometry2::turn(angle, about);
    ASSERT_TRUE(g.centre().has_value());
    EXPECT_LT((*g.centre() - about).norm(), 1e-9);  // 1 / (1 - cos) amplifies rounding at small turns
    const Eigen::Vector2d q(1.0, 7.0);
    EXPECT_LT((Isometry2::taking(angle, i % 2 == 0, about, q) * about - q).norm(), 20 * rounding);
  }
  EXPECT_FALSE((Isometry2{0.0, {1.0, 0.0}, false}.centre().has_value()));
}

TEST(Isometry2, ImagesOfPolygonsKeepTheirSense) {
  const Polygon2 triangle = {{0.0, 0.0}, {2.0, 0.0}, {0.0, 1.0}};
  EXPECT_NEAR(signed_area(Isometry2{0.7, {1.0, 2.0}, true} * triangle), 1.0, rounding);
  EXPECT_NEAR(signed_area(Isometry2{0.7, {1.0, 2.0}, false} * triangle), 1.0, rounding);
}

}  // namespace
}  // namespace plumbline::bim
