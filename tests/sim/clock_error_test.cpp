// SPDX-License-Identifier: Apache-2.0
#include "sim/clock_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumbline::sim {
namespace {

constexpr slam::Nanoseconds step_ns = 2'000'000;
constexpr std::int64_t every = 5;

/// Differences of the stamps that come out from the true ones, and whether the order is kept.
struct Stamps {
  std::vector<double> error_s;
  std::int64_t missing = 0;
};

Stamps stamps_of(const ClockConfig& config, std::int64_t steps) {
  StampError clock(config, 3, 0);
  Stamps out;
  slam::Nanoseconds last = -1;
  for (std::int64_t step = 0; step < steps; step += every) {
    const auto stamp = clock.stamp(step, step * step_ns);
    if (!stamp) {
      ++out.missing;
      continue;
    }
    EXPECT_GT(*stamp, last);
    EXPECT_LE(step * step_ns, *stamp + longest_lead(config));
    last = *stamp;
    out.error_s.push_back(slam::seconds(*stamp - step * step_ns));
  }
  return out;
}

TEST(StampError, OfARightClockIsNone) {
  const Stamps stamps = stamps_of({}, 1000);
  EXPECT_EQ(stamps.missing, 0);
  EXPECT_EQ(longest_lead({}), 0);
  for (const double error_s : stamps.error_s) EXPECT_EQ(error_s, 0.0);
}

TEST(StampError, ShiftsEveryStampButTheFirst) {
  const Stamps late = stamps_of({0.05, 0.0}, 1000);
  EXPECT_EQ(late.missing, 0);
  EXPECT_EQ(late.error_s[0], 0.0);
  for (std::size_t i = 1; i < late.error_s.size(); ++i) EXPECT_NEAR(late.error_s[i], 0.05, 1e-12);
  const Stamps early = stamps_of({-0.05, 0.0}, 1000);
  EXPECT_EQ(early.missing, 5) << "those that would be before the first, or with it";
  EXPECT_EQ(early.error_s[0], 0.0);
  for (std::size_t i = 1; i < early.error_s.size(); ++i) EXPECT_NEAR(early.error_s[i], -0.05, 1e-12);
}

TEST(StampError, JittersByItsStandardDeviation) {
  const Stamps stamps = stamps_of({0.02, 0.001}, 100000);
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(stamps.error_s.size() - 1);
  for (std::size_t i = 1; i < stamps.error_s.size(); ++i) sum += stamps.error_s[i] - 0.02;
  for (std::size_t i = 1; i < stamps.error_s.size(); ++i) squares += std::pow(stamps.error_s[i] - 0.02, 2);
  // Five standard errors; cutting at three takes 1.3 % of the standard deviation.
  EXPECT_NEAR(sum / n, 0.0, 5.0 * 0.001 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.001, 0.001 * (0.014 + 5.0 / std::sqrt(2.0 * n)));
}

TEST(StampError, KeepsTheOrderWhereJitterIsLongerThanTheInterval) {
  const Stamps stamps = stamps_of({-0.01, 0.03}, 10000);
  EXPECT_GT(stamps.error_s.size(), 1990U);
}

TEST(StampError, KindsOfRecordsJitterByThemselves) {
  StampError odometry({0.0, 0.001}, 3, 0), imu({0.0, 0.001}, 3, 1);
  EXPECT_NE(odometry.stamp(500, 1'000'000'000), imu.stamp(500, 1'000'000'000));
}

}  // namespace
}  // namespace plumbline::sim
