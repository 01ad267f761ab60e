// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/loop_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumbline::scenarios::score {
namespace {

constexpr double step_m = 0.25;

/// 20 m along x and back again, a scan every 0.25 m; the heading stays.
Truth there_and_back() {
  Truth truth;
  for (int i = 0; i <= 160; ++i) {
    const double way_m = step_m * i;
    const double x = way_m <= 20.0 ? way_m : 40.0 - way_m;
    truth.scans.push_back(i);
    truth.poses_W.push_back({i, Pose::from_xyz_yaw({x, 0.0, 0.5}, 0.0)});
  }
  return truth;
}

slam::Nanoseconds after(double way_m) { return std::lround(way_m / step_m); }

/// Of the true relative pose, off by so much.
slam::LoopEdge loop(const Truth& truth, double from_m, double to_m, double off_m = 0.0, double off_deg = 0.0) {
  const Pose off = Pose::from_xyz_yaw({0.0, off_m, 0.0}, off_deg * std::numbers::pi / 180.0);
  return {after(from_m), after(to_m), truth.at(after(from_m)).inverse() * truth.at(after(to_m)) * off};
}

// Back at x, the way since x - 1 m is 2 (s - 20) + 1 for a way of s: at least 10 m from s = 24.5 on.
TEST(Loops, RevisitsAreCutIntoPieces) {
  const std::vector<Revisit> pieces = revisits(there_and_back());
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].from_m, 24.5);
  EXPECT_EQ(pieces[0].to_m, 34.5);
  EXPECT_EQ(pieces[1].from_m, 34.75);
  EXPECT_EQ(pieces[1].to_m, 40.0);
}

TEST(Loops, AnotherStoreyIsNoRevisit) {
  Truth truth = there_and_back();
  for (std::size_t i = 80; i < truth.poses_W.size(); ++i) truth.poses_W[i].X_FR.t.z() += 3.0;
  EXPECT_TRUE(revisits(truth).empty());
  EXPECT_FALSE(score_loops({}, truth).recall.has_value());
}

TEST(Loops, PrecisionAndRecall) {
  const Truth truth = there_and_back();
  const LoopScore none = score_loops({}, truth);
  EXPECT_FALSE(none.precision.has_value());
  EXPECT_EQ(*none.recall, 0.0);

  const LoopScore one = score_loops({loop(truth, 5, 35), loop(truth, 4, 36), loop(truth, 12, 28, 0.21)}, truth);
  EXPECT_EQ(one.found, 3);
  EXPECT_EQ(one.right, 2);
  EXPECT_EQ(one.revisits, 2);
  EXPECT_EQ(one.closed, 1);  // both right ones end in the second piece, the wrong one closes nothing
  EXPECT_DOUBLE_EQ(*one.precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(*one.recall, 0.5);

  EXPECT_EQ(score_loops({loop(truth, 12, 28, 0.19, 2.9)}, truth).closed, 1);
  EXPECT_EQ(score_loops({loop(truth, 12, 28, 0.0, 3.1)}, truth).right, 0);
  EXPECT_EQ(score_loops({loop(truth, 18, 22)}, truth).right, 1);  // right, but nothing was revisited there
  EXPECT_EQ(score_loops({loop(truth, 18, 22)}, truth).closed, 0);
  // The order of the two ends does not matter.
  EXPECT_EQ(score_loops({loop(truth, 28, 12)}, truth).closed, 1);
}

}  // namespace
}  // namespace plumbline::scenarios::score
