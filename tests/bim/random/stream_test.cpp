// SPDX-License-Identifier: Apache-2.0
#include "bim/random/stream.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "bim/errors.h"

namespace plumbline {
namespace {

TEST(Stream, NamesAreUnique) {
  const auto names = stream_names();
  EXPECT_EQ(std::set<std::string_view>(names.begin(), names.end()).size(), names.size());
}

TEST(Stream, RefusesUnknownNames) { EXPECT_THROW(Stream(1, "sim.unknown"), InternalError); }

TEST(Stream, DependsOnSeedNameAndAddressOnly) {
  const Stream a(7, "sim.lidar.range");
  EXPECT_EQ(a.bits(5, 6, 7), Stream(7, "sim.lidar.range").bits(5, 6, 7));
  const std::set<std::uint64_t> all = {a.bits(5, 6, 7),
                                       a.bits(6, 6, 7),
                                       a.bits(5, 7, 7),
                                       a.bits(5, 6, 8),
                                       Stream(8, "sim.lidar.range").bits(5, 6, 7),
                                       Stream(7, "sim.lidar.dropout").bits(5, 6, 7)};
  EXPECT_EQ(all.size(), 6U);
}

TEST(Stream, PartsOfARunDifferAndTheFirstIsTheRun) {
  const Stream run(5, "sim.lidar.range"), first(Seed{5, 0}, "sim.lidar.range"), second(Seed{5, 1}, "sim.lidar.range"),
      other(6, "sim.lidar.range");
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    EXPECT_EQ(first.bits(tick), run.bits(tick));
    EXPECT_NE(second.bits(tick), run.bits(tick));
    EXPECT_NE(second.bits(tick), other.bits(tick));
  }
}

TEST(Stream, GaussHasUnitMoments) {
  const Stream stream(3, "sim.lidar.range");
  constexpr int n = 200000;
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = stream.gauss(static_cast<std::uint64_t>(i));
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
  }
  // Five standard errors of each sample moment of a normal: 1, sqrt(2) and sqrt(96) over sqrt(n).
  const double root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(sum / n, 0.0, 5.0 / root);
  EXPECT_NEAR(sum2 / n, 1.0, 5.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(sum4 / n, 3.0, 5.0 * std::sqrt(96.0) / root);
}

TEST(Stream, FourGaussOfABlockAreBoxMullersOfItsBits) {
  const Stream stream(3, "slam.localize.motion");
  for (std::uint64_t tick = 0; tick < 2000; ++tick) {
    const std::uint64_t bits = stream.bits(tick, 1, 2);
    const double u1 = (static_cast<double>(bits >> 32U) + 0.5) * 0x1.0p-32;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(bits & 0xFFFFFFFFU) * 0x1.0p-32;
    const double far = std::sqrt(-2.0 * std::log(u1));
    const std::array<double, 4> four = stream.gauss4(tick, 1, 2);
    // The series are exact to 1e-13; the root of a logarithm near 0 loses a few digits.
    EXPECT_NEAR(four[0], far * std::cos(angle), 1e-11);
    EXPECT_NEAR(four[1], far * std::sin(angle), 1e-11);
  }
}

TEST(Stream, FourGaussHaveUnitMomentsAndAreIndependent) {
  const Stream stream(3, "slam.localize.motion");
  constexpr int n = 200000;
  std::array<double, 4> sum{}, sum4{};
  std::array<std::array<double, 4>, 4> products{};
  for (int i = 0; i < n; ++i) {
    const std::array<double, 4> x = stream.gauss4(5, static_cast<std::uint32_t>(i));
    for (std::size_t a = 0; a < 4; ++a) {
      sum[a] += x[a];
      sum4[a] += x[a] * x[a] * x[a] * x[a];
      for (std::size_t b = 0; b < 4; ++b) products[a][b] += x[a] * x[b];
    }
  }
  // Five standard errors of each: 1, sqrt(96), and of products sqrt(2) with itself and 1 with another.
  const double root = std::sqrt(static_cast<double>(n));
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_NEAR(sum[a] / n, 0.0, 5.0 / root);
    EXPECT_NEAR(sum4[a] / n, 3.0, 5.0 * std::sqrt(96.0) / root);
    for (std::size_t b = 0; b < 4; ++b)
      EXPECT_NEAR(products[a][b] / n, a == b ? 1.0 : 0.0, 5.0 * (a == b ? std::sqrt(2.0) : 1.0) / root);
  }
}

TEST(Stream, MethodSeedsDiffer) {
  EXPECT_NE(method_seed(1, "vgicp"), method_seed(1, "odometry"));
  EXPECT_NE(method_seed(1, "vgicp"), method_seed(2, "vgicp"));
  EXPECT_NE(method_seed(1, "vgicp"), 1U);
}

}  // namespace
}  // namespace plumbline
