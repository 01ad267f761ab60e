// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/time_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/random/stream.h"
#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

constexpr slam::Nanoseconds second_ns = 1'000'000'000;

/// A walk of a minute at speeds and rates of turning that change every second.
Truth random_walk(const Stream& random, std::uint64_t trial) {
  Truth truth;
  Pose X_WR;
  for (int i = 0; i < 600; ++i) {
    const auto draw = 1000 * trial + static_cast<std::uint64_t>(i / 10);
    truth.scans.push_back(i * scan_ns);
    truth.poses_W.push_back({i * scan_ns, X_WR});
    X_WR = X_WR * Pose::from_xyz_yaw({0.1 * random.uniform(draw, 0), 0.0, 0.0}, 0.2 * (random.uniform(draw, 1) - 0.5));
  }
  return truth;
}

/// As a program with a clock and a frame of its own answers, from its scan `first` on.
std::vector<slam::StampedPose> elsewhere(const Truth& truth, slam::Nanoseconds later, std::size_t first) {
  const Pose X_FW = Pose::from_xyz_yaw({7.0, -3.0, 1.0}, 2.0);
  std::vector<slam::StampedPose> poses_F;
  for (std::size_t i = first; i < truth.poses_W.size(); ++i)
    poses_F.push_back({truth.poses_W[i].stamp + later, X_FW * truth.poses_W[i].X_FR});
  return poses_F;
}

TEST(TimeShift, IsFoundWhateverTheClockAndTheFrame) {
  const Stream random(11, "bim.generate");
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const Truth truth = random_walk(random, trial);
    const auto later = static_cast<slam::Nanoseconds>(std::llround(1e12 * (random.uniform(900 + trial, 2) - 0.5)));
    const auto first = static_cast<std::size_t>(100.0 * random.uniform(900 + trial, 3));
    EXPECT_EQ(find_shift(truth, elsewhere(truth, later, first)), -later) << "trial " << trial;
  }
}

TEST(TimeShift, IsNotFoundWhereTheMotionIsTheSameAtAllTimes) {
  const Truth truth = straight_walk(600, {0.0, 0.0, 0.0}, 0.05);
  EXPECT_FALSE(find_shift(truth, elsewhere(truth, second_ns, 0)));
}

// Its length is what a file says: with a step of 0.1 s, centuries would fill the memory.
TEST(TimeShift, IsNotSearchedForInAnEstimateOfCenturies) {
  const Truth truth = random_walk(Stream(11, "bim.generate"), 0);
  EXPECT_FALSE(find_shift(truth, {{0, Pose()}, {8'000'000'000 * second_ns, Pose()}}));
  EXPECT_FALSE(find_shift(truth, {{-9'000'000'000 * second_ns, Pose()}, {9'000'000'000 * second_ns, Pose()}}));
}

}  // namespace
}  // namespace plumbline::scenarios::score
