// SPDX-License-Identifier: Apache-2.0
#include "bim/random/stream.h"

#include <gtest/gtest.h>

#include <cmath>
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

TEST(Stream, MethodSeedsDiffer) {
  EXPECT_NE(method_seed(1, "vgicp"), method_seed(1, "odometry"));
  EXPECT_NE(method_seed(1, "vgicp"), method_seed(2, "vgicp"));
  EXPECT_NE(method_seed(1, "vgicp"), 1U);
}

}  // namespace
}  // namespace plumbline
