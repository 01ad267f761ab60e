// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/sweep_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

Scan timed_scan() {
  return synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({3.0, 2.0, 0.46}, 0.3), {});
}

Scan untimed(Scan scan) {
  std::fill(scan.offset_ns.begin(), scan.offset_ns.end(), 0);
  return scan;
}

SweepTimes at_interval(Nanoseconds interval) {
  SweepTimes times;
  Scan scan = untimed(timed_scan());
  for (int k = 0; k < 5; ++k) {
    scan.stamp += interval;
    times.add(scan);
  }
  return times;
}

/// Seconds from the first return to the last, as inferred.
double sweep_s(const SweepTimes& times, const Scan& scan) {
  const std::optional<Scan> inferred = times.with_times(scan);
  if (!inferred) return 0.0;
  return -seconds(*std::min_element(inferred->offset_ns.begin(), inferred->offset_ns.end()));
}

TEST(SweepTimes, AreThoseOfTheFirings) {
  const Scan scan = timed_scan();
  for (const bool rings : {true, false}) {
    Scan poor = untimed(scan);
    if (!rings) {
      poor.columns *= poor.rings;
      poor.rings = 1;
    }
    const std::optional<Scan> inferred = at_interval(100'000'000).with_times(poor);
    ASSERT_TRUE(inferred);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.range_m[i] <= 0.0) continue;
      // 0.5 deg of azimuth, by which lasers of a firing are apart, are 0.14 ms.
      EXPECT_NEAR(seconds(inferred->offset_ns[i]), seconds(scan.offset_ns[i]), 5e-4) << i;
    }
  }
}

TEST(SweepTimes, GoRoundEitherWay) {
  Scan mirrored = untimed(timed_scan());
  for (Eigen::Vector3d& p : mirrored.point_L) p.y() = -p.y();
  const std::vector<float> turns = turns_at_slots(mirrored);
  ASSERT_FALSE(turns.empty());
  EXPECT_NEAR(turns.back(), 1.0F, 0.02F);
}

TEST(SweepTimes, ASensorThatDoesNotSpinHasNone) {
  Scan scan = untimed(timed_scan());
  for (std::size_t i = 0; i < scan.size(); ++i) std::swap(scan.point_L[i], scan.point_L[(i * 7919) % scan.size()]);
  EXPECT_TRUE(turns_at_slots(scan).empty());
  Scan ahead = untimed(timed_scan());
  for (std::size_t i = 0; i < ahead.size(); ++i)
    if (ahead.point_L[i].x() < std::abs(ahead.point_L[i].y())) ahead.range_m[i] = 0.0;
  EXPECT_TRUE(turns_at_slots(ahead).empty());
  EXPECT_TRUE(turns_at_slots(Scan{}).empty());
  SweepTimes times = at_interval(100'000'000);
  for (int k = 0; k < 20; ++k) times.add_not_spinning();
  EXPECT_TRUE(times.is_settled());
}

TEST(SweepTimes, ASweepLastsAsLongAsScansAreApartOrTheUsualTenth) {
  const Scan scan = untimed(timed_scan());
  for (const double interval_s : {0.05, 0.1, 0.2})
    EXPECT_NEAR(sweep_s(at_interval(std::llround(1e9 * interval_s)), scan), interval_s, 0.02 * interval_s);
  EXPECT_NEAR(sweep_s(at_interval(500'000'000), scan), 0.1, 0.002) << "of every fifth scan";
  EXPECT_TRUE(at_interval(10'000'000).is_settled()) << "no head turns a hundred times a second";
  EXPECT_FALSE(SweepTimes().with_times(scan)) << "the rate is not known yet";
}

TEST(SweepTimes, ScansWithTimesKeepThem) {
  SweepTimes times;
  times.add(timed_scan());
  EXPECT_TRUE(times.is_settled());
  EXPECT_FALSE(times.are_inferred());
  EXPECT_FALSE(at_interval(100'000'000).with_times(timed_scan()));
}

struct Fit {
  double residual_m = 0.01;
  bool lost = false;
};

/// After so many scans of a robot that makes 6 cm a scan, of which every third is worse for both.
SweepTimes compared(const Fit& as_is, const Fit& timed, int scans, const Pose& step) {
  SweepTimes times = at_interval(100'000'000);
  Scan scan = untimed(timed_scan());
  scan.stamp += 600'000'000;
  for (int k = 0; k < scans; ++k, scan.stamp += 100'000'000) {
    times.add(scan);
    Registration a, b;
    const double worse = k % 3 == 0 ? 1.2 : 1.0;
    a.residual_m = as_is.residual_m * worse;
    b.residual_m = timed.residual_m * (k % 2 == 0 ? 1.1 : 1.0);
    a.lost = as_is.lost;
    b.lost = timed.lost;
    times.compare({a, step}, {b, step});
  }
  return times;
}

TEST(SweepTimes, AreTakenWhereTheyFitClearlyBetter) {
  const Pose walked = Pose::from_xyz_yaw({0.06, 0.0, 0.0}, 0.0);
  const SweepTimes raw = compared({0.02}, {0.01}, 60, walked);
  EXPECT_TRUE(raw.is_settled());
  EXPECT_TRUE(raw.are_inferred());
  const SweepTimes deskewed = compared({0.01}, {0.02}, 60, walked);
  EXPECT_TRUE(deskewed.is_settled());
  EXPECT_FALSE(deskewed.are_inferred());
  EXPECT_FALSE(compared({0.01}, {0.01}, 60, walked).is_settled()) << "both fit";
  EXPECT_TRUE(compared({0.01}, {0.01}, 400, walked).is_settled()) << "it will not be known";
  EXPECT_FALSE(compared({0.01}, {0.01}, 400, walked).are_inferred());
  EXPECT_FALSE(compared({0.02}, {0.01}, 60, Pose{}).are_inferred()) << "a robot at rest bends nothing";
  EXPECT_FALSE(compared({0.02}, {0.01}, 2, walked).are_inferred()) << "of two scans";
  EXPECT_TRUE(compared({0.02, true}, {0.01}, 3, walked).are_inferred()) << "as they are they are lost";
}

}  // namespace
}  // namespace plumbline::slam
