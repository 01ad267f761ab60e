// SPDX-License-Identifier: Apache-2.0
#include "sim/route/route_progress.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::sim {
namespace {

/// Time at which a robot stalls that is left_m(t) from its waypoint and error(t) off its heading; -1 never, in a
/// minute.
template <class Left, class Error>
double stall_s(bool stairs, Left&& left_m, Error&& error) {
  Progress progress({});
  for (int i = 0; i < 6000; ++i)
    if (progress.stalled(1, stairs, left_m(0.01 * i), error(0.01 * i), 0.01 * i)) return 0.01 * i;
  return -1.0;
}

double none(double) { return 0.0; }

TEST(Progress, StandingIsAStallAfterSixSecondsOrTenOnStairs) {
  const auto stands = [](double) { return 3.0; };
  EXPECT_NEAR(stall_s(false, stands, none), 6.0, 0.02);
  EXPECT_NEAR(stall_s(true, stands, none), 10.0, 0.02);
}

TEST(Progress, WalkingSlowlyIsNone) {
  EXPECT_EQ(stall_s(
                false, [](double t) { return 10.0 - 0.05 * t; }, none),
            -1.0);
}

TEST(Progress, TurningOnTheSpotIsNoneWhileTheErrorShrinks) {
  const auto stands = [](double) { return 3.0; };
  EXPECT_NEAR(stall_s(false, stands, [](double t) { return std::max(0.0, 3.0 - 0.2 * t); }), 15.0 + 6.0, 1.0);
}

TEST(Progress, ComingAndGoingIsAStall) {
  const auto sways = [](double t) { return 3.0 + 0.5 * std::sin(2.0 * t); };
  const auto looks_about = [](double t) { return 0.8 * std::cos(t); };
  const double at = stall_s(true, sways, looks_about);
  EXPECT_GT(at, 10.0);
  EXPECT_LT(at, 20.0);
}

TEST(Progress, ANewLegBeginsAnew) {
  Progress progress({});
  EXPECT_FALSE(progress.stalled(1, false, 1.0, 0.0, 0.0));
  EXPECT_FALSE(progress.stalled(2, false, 5.0, 0.0, 5.9));
  EXPECT_FALSE(progress.stalled(2, false, 5.0, 0.0, 11.8));
  EXPECT_TRUE(progress.stalled(2, false, 5.0, 0.0, 12.0));
}

}  // namespace
}  // namespace plumbline::sim
