// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/clock_offset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct Found {
  Nanoseconds at_end = 0, farthest = 0;
};

/// By a walk whose odometry is stamped `late`.
Found find(synthetic::Recording recording, Nanoseconds late) {
  for (Odometry& odometry : recording.odometry) odometry.stamp += late;
  ClockOffset offset(recording.calibration);
  Found found;
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp; ++next)
      offset.add(recording.odometry[next]);
    offset.add(scan);
    found.at_end = offset.value();
    if (std::abs(found.at_end) > std::abs(found.farthest)) found.farthest = found.at_end;
  }
  return found;
}

synthetic::Recording turning_walk(std::uint64_t seed, double duration_s = 25.0) {
  synthetic::WalkConfig config;
  config.seed = seed;
  config.duration_s = duration_s;
  return synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
}

TEST(ClockOffset, IsFoundWhereARobotTurns) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const synthetic::Recording recording = turning_walk(seed);
    for (const int late_ms : {-390, -200, -60, 45, 100, 220, 390}) {
      const Nanoseconds late = late_ms * 1'000'000LL;
      // Measured: at most 4 ms.
      EXPECT_LT(std::abs(find(recording, late).at_end - late), 6'000'000) << late_ms << " " << seed;
    }
    // It costs less than what may be found instead.
    EXPECT_EQ(find(recording, 8'000'000).farthest, 0) << seed;
  }
}

TEST(ClockOffset, IsNeverTakenWhereThereIsNone) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) EXPECT_EQ(find(turning_walk(seed), 0).farthest, 0) << seed;
}

// The structure that tells a turn is seen in one part of the sweep there.
TEST(ClockOffset, IsNotBiasedByTheCornerOfAHall) {
  const std::vector<Eigen::Vector2d> lap = {{1.0, 0.9}, {8.0, 0.9}, {8.0, 1.4}, {1.0, 1.4}};
  for (const bool clockwise : {false, true}) {
    std::vector<Eigen::Vector2d> way;
    for (int k = 0; k < 3; ++k) way.insert(way.end(), lap.begin(), lap.end());
    if (clockwise) std::reverse(way.begin(), way.end());
    synthetic::WalkConfig config;
    config.speed_mps = 0.9;
    const synthetic::Recording recording = synthetic::walk(synthetic::one_room(25.0, 20.0), way, config);
    for (const Nanoseconds late : {-100'000'000, 20'000'000, 100'000'000}) {
      const Found found = find(recording, late);
      // Measured: at most 4 ms.
      EXPECT_LT(std::abs(found.at_end - late), 6'000'000) << late << " " << clockwise;
    }
  }
}

TEST(ClockOffset, IsNotFoundWithoutTimesNorByARobotThatGoesStraight) {
  synthetic::Recording untimed = turning_walk(1);
  for (Scan& scan : untimed.scans) std::fill(scan.offset_ns.begin(), scan.offset_ns.end(), 0);
  EXPECT_EQ(find(untimed, 100'000'000).farthest, 0);

  synthetic::WalkConfig straight;
  straight.odometry_yaw_sigma = 0.0;
  const std::vector<Eigen::Vector2d> along = {{1.0, 1.1}, {13.0, 1.1}};
  EXPECT_EQ(find(synthetic::walk(synthetic::corridor_house(), along, straight), 100'000'000).farthest, 0);
}

TEST(ClockOffset, IsNotFoundByASensorThatStandsAskew) {
  synthetic::Recording askew = turning_walk(1);
  askew.calibration.X_RL.q = exp_so3({0.6, 0.0, 0.0});
  EXPECT_EQ(find(askew, 100'000'000).farthest, 0);
}

TEST(ClockOffset, LivesOnWithoutOdometryAndWithNonsense) {
  const synthetic::Recording recording = turning_walk(1, 6.0);
  ClockOffset offset(recording.calibration);
  for (const Scan& scan : recording.scans) offset.add(scan);
  Odometry nonsense = recording.odometry.back();
  nonsense.X_OR.t.x() = std::nan("");
  offset.add(nonsense);
  offset.add(Scan{});
  Scan endless = recording.scans.back();
  endless.offset_ns.front() = -2'000'000'000;
  offset.add(endless);
  EXPECT_EQ(offset.value(), 0);
}

}  // namespace
}  // namespace plumbline::slam
