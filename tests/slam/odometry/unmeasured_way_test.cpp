// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/unmeasured_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace plumbline::slam {
namespace {

constexpr double limit_m = 1.0;

Nanoseconds period(double rate_hz) { return static_cast<Nanoseconds>(1e9 / rate_hz); }

// Random accelerations take as long at 2 Hz as at 20.
TEST(UnmeasuredWay, GrowsWithTimeWhateverTheRate) {
  for (const double rate_hz : {2.0, 5.0, 10.0, 20.0}) {
    UnmeasuredWay way(limit_m);
    double before_m = 0.0, lost_s = 0.0;
    for (int k = 0; k < static_cast<int>(4.0 * rate_hz); ++k) {
      way.add_open(period(rate_hz));
      EXPECT_GT(way.open_m(), before_m);
      before_m = way.open_m();
      if (!way.lost()) lost_s += 1.0 / rate_hz;
    }
    EXPECT_NEAR(lost_s, 1.96, 0.5) << "2 m/s^2 for 0.1 s each, integrated";
    EXPECT_TRUE(way.displaced()) << "the map drifted with the robot";
  }
}

// 0.6 m/s^2 at least: a robot that stops at 0.6 m/s is a metre off after 1.7 s, and LOST within three seconds of that.
TEST(UnmeasuredWay, GrowsByTheAccelerationsThatWereMeasured) {
  const auto lost_after_s = [](double acceleration_mps2, double rate_hz) {
    UnmeasuredWay way(limit_m);
    const double dt_s = 1.0 / rate_hz, speed = acceleration_mps2 * std::min(dt_s, std::sqrt(0.1 * dt_s));
    way.measure_acceleration(speed * dt_s, period(rate_hz));
    double s = 0.0;
    for (; !way.lost(); s += dt_s) way.add_open(period(rate_hz));
    return s;
  };
  for (const double rate_hz : {5.0, 10.0, 20.0}) {
    EXPECT_NEAR(lost_after_s(2.0, rate_hz), 1.96, 0.2);
    EXPECT_NEAR(lost_after_s(1.0, rate_hz), 3.11, 0.2);
    EXPECT_NEAR(lost_after_s(0.1, rate_hz), 4.37, 0.2);
    EXPECT_NEAR(lost_after_s(50.0, rate_hz), 1.96, 0.2);
  }
}

TEST(UnmeasuredWay, ScansOfTheSameMapTakeBackWhatTheyDidNotSee) {
  UnmeasuredWay way(limit_m);
  for (int k = 0; k < 30; ++k) way.add_frozen(period(10.0), 1.0);
  EXPECT_GT(way.open_m(), 3.0);
  EXPECT_TRUE(way.lost());
  way.add_measured(period(10.0), false);
  EXPECT_TRUE(way.lost()) << "half of a scan fits anywhere";
  for (int k = 0; k < 60; ++k) way.add_measured(period(10.0), true);
  EXPECT_FALSE(way.lost());
  EXPECT_FALSE(way.displaced());
}

TEST(UnmeasuredWay, ALoopClosureLocatesAMapAgain) {
  UnmeasuredWay way(limit_m);
  for (int k = 0; k < 40; ++k) way.add_open(period(10.0));
  for (int k = 0; k < 100; ++k) way.add_measured(period(10.0), true);
  EXPECT_FALSE(way.lost());
  EXPECT_TRUE(way.displaced());
  way.locate_map();
  EXPECT_FALSE(way.displaced());
}

TEST(UnmeasuredWay, AnAliasIsNotMadeUpFor) {
  UnmeasuredWay way(limit_m);
  way.add_doubtful(0.9 * limit_m);
  EXPECT_FALSE(way.displaced());
  way.add_doubtful(1.1 * limit_m);
  for (int k = 0; k < 1000; ++k) way.add_measured(period(10.0), true);
  EXPECT_FALSE(way.lost());
  EXPECT_TRUE(way.displaced());
  way.locate_map();
  EXPECT_FALSE(way.displaced());
}

TEST(UnmeasuredWay, ADoubtIsSettledOnTheMapThatItBeganOn) {
  UnmeasuredWay way(limit_m);
  way.add_doubtful(1.1 * limit_m);
  EXPECT_TRUE(way.is_doubtful());
  way.settle_doubt();
  EXPECT_FALSE(way.displaced());
  way.add_doubtful(1.1 * limit_m);
  way.begin_map();
  EXPECT_FALSE(way.is_doubtful());
  way.settle_doubt();
  EXPECT_TRUE(way.displaced()) << "the map of before is gone";
}

TEST(UnmeasuredWay, ANewMapDoesNotKnowWhereItIs) {
  UnmeasuredWay way(limit_m);
  for (int k = 0; k < 30; ++k) way.add_frozen(period(10.0), 1.0);
  way.begin_map();
  for (int k = 0; k < 1000; ++k) way.add_measured(period(10.0), true);
  EXPECT_FALSE(way.lost());
  EXPECT_TRUE(way.displaced());
  UnmeasuredWay standing(limit_m);
  for (int k = 0; k < 10; ++k) standing.add_frozen(period(10.0), 0.0);
  standing.begin_map();
  EXPECT_FALSE(standing.displaced()) << "a second without scans of a robot that stood";
}

TEST(UnmeasuredWay, AScanPlacedAgainstAnEarlierOneIsKnownAsWellAsThatWas) {
  UnmeasuredWay way(limit_m);
  way.add_open(period(2.0));
  const UnmeasuredWay then = way;
  while (!way.displaced()) way.add_open(period(2.0));
  const UnmeasuredWay now = way;
  way.measure_from(then);
  EXPECT_EQ(way.open_m(), then.open_m());
  EXPECT_FALSE(way.lost());
  EXPECT_FALSE(way.displaced());
  way.measure_from(now);
  EXPECT_EQ(way.open_m(), then.open_m()) << "a worse one takes nothing away";
}

}  // namespace
}  // namespace plumbline::slam
