// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/two_step.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::slam::lego {
namespace {

/// Whole steps, so that an answer can be compared.
const TwoStepConfig whole{.step_share = 1.0};

/// A floor with points on four rows, and upright edges of two points or more each, in R.
struct World {
  std::vector<FormerPoint> floor, edges;
};

World world() {
  World w;
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k < 60; ++k) {
      const double angle = 0.1047 * k, range_m = 3.0 + row;
      w.floor.push_back({{range_m * std::cos(angle), range_m * std::sin(angle), -0.5}, row});
    }
  for (int k = 0; k < 8; ++k)
    for (int row = 5; row < 9; ++row)
      w.edges.push_back({{4.0 * std::cos(0.8 * k), (3.0 + 0.2 * k) * std::sin(0.8 * k), 0.2 * (row - 6)}, row});
  return w;
}

FormerScan former(const World& w) { return {w.edges, w.floor}; }

/// What the scan after that motion sees, at its end.
Features seen(const World& w, const Motion& motion) {
  const Pose X = motion.at(1.0).inverse();
  Features features;
  const auto put = [&](const std::vector<FormerPoint>& points, std::vector<ImagePoint>& into) {
    for (const FormerPoint& point : points) {
      ImagePoint one;
      one.p_R = X * point.p;
      one.range_m = one.p_R.norm();
      one.row = point.row;
      into.push_back(one);
    }
  };
  put(w.floor, features.flat);
  put(w.edges, features.sharp);
  return features;
}

TEST(TwoStep, FindsTiltAndHeightByGroundAndTheRestByEdges) {
  const World w = world();
  Motion motion;
  motion.rpy = {0.01, -0.008, 0.03};
  motion.t = {0.06, -0.03, 0.02};
  const TwoStepResult found = two_step(seen(w, motion), former(w), {}, whole);
  ASSERT_TRUE(found.by_ground && found.by_edges);
  EXPECT_EQ(found.degenerate, 0);
  // The second step does not go back to the first, so that what yaw does to height stays: some millimetres.
  EXPECT_LT((found.motion.rpy - motion.rpy).norm(), 0.003);
  EXPECT_LT((found.motion.t - motion.t).norm(), 0.006);
}

TEST(TwoStep, WhatAStepDoesNotSolveStaysToTheBit) {
  const World w = world();
  Motion guess;
  guess.rpy = {0.001, 0.002, 0.0123456789};
  guess.t = {0.0101, -0.0202, 0.003};
  Features ground_alone = seen(w, {});
  ground_alone.sharp.clear();
  const TwoStepResult first = two_step(ground_alone, former(w), guess, whole);
  EXPECT_TRUE(first.by_ground);
  EXPECT_FALSE(first.by_edges);
  EXPECT_EQ(first.motion.rpy.z(), guess.rpy.z());
  EXPECT_EQ(first.motion.t.head<2>(), guess.t.head<2>());
  Features edges_alone = seen(w, {});
  edges_alone.flat.clear();
  const TwoStepResult second = two_step(edges_alone, former(w), guess, whole);
  EXPECT_FALSE(second.by_ground);
  EXPECT_TRUE(second.by_edges);
  EXPECT_EQ(second.motion.rpy.head<2>(), guess.rpy.head<2>());
  EXPECT_EQ(second.motion.t.z(), guess.t.z());
}

TEST(TwoStep, YawAndHeightAreFoundByTheRightStep) {
  const World w = world();
  Motion turned;
  turned.rpy.z() = 0.04;
  const TwoStepResult yaw = two_step(seen(w, turned), former(w), {}, whole);
  EXPECT_NEAR(yaw.motion.rpy.z(), 0.04, 1e-4);
  EXPECT_NEAR(yaw.motion.t.z(), 0.0, 1e-4);
  Motion lifted;
  lifted.t.z() = 0.05;
  const TwoStepResult height = two_step(seen(w, lifted), former(w), {}, whole);
  EXPECT_NEAR(height.motion.t.z(), 0.05, 1e-4);
  EXPECT_NEAR(height.motion.rpy.z(), 0.0, 1e-4);
}

// Height is held by as many points as see the floor, whenever within the sweep they saw it: indoors 20 are few.
TEST(TwoStep, FewPointsOverAWholeSweepHoldTheHeight) {
  const World w = world();
  Motion lifted;
  lifted.t.z() = 0.02;
  Features now = seen(w, lifted);
  std::vector<ImagePoint> few;
  for (std::size_t i = 0; i < now.flat.size(); i += 12) {
    ImagePoint point = now.flat[i];
    point.share = static_cast<double>(few.size() + 1) / 20.0;
    point.p_R.z() = w.floor[i].p.z() - point.share * lifted.t.z();
    few.push_back(point);
  }
  ASSERT_EQ(few.size(), 20U);
  now.flat = few;
  const TwoStepResult found = two_step(now, former(w), {}, whole);
  EXPECT_EQ(found.degenerate, 0);
  EXPECT_NEAR(found.motion.t.z(), 0.02, 1e-3);
}

// Edges along x alone, as the skirting of a bare corridor: nothing tells how far it went.
TEST(TwoStep, ADegenerateDirectionIsLeftAsItIs) {
  World w = world();
  w.edges.clear();
  for (int side = -1; side <= 1; side += 2)
    for (int k = 0; k < 20; ++k)
      for (int row = 5; row < 7; ++row) w.edges.push_back({{0.5 * k - 5.0 + 0.1 * row, 1.5 * side, 1.0}, row});
  Motion motion;
  motion.t = {0.1, 0.02, 0.0};
  const TwoStepResult found = two_step(seen(w, motion), former(w), {}, whole);
  EXPECT_EQ(found.degenerate, 1);
  EXPECT_NEAR(found.motion.t.x(), 0.0, 1e-6);
  EXPECT_NEAR(found.motion.t.y(), 0.02, 1e-3);
}

// As in the reference: 25 steps of a twentieth take at most 72 % of the way, and it stops 2 cm before the end.
TEST(TwoStep, ATwentiethOfEachStepLeavesSome) {
  const World w = world();
  Motion lifted;
  lifted.t.z() = 0.2;
  const TwoStepResult found = two_step(seen(w, lifted), former(w), {}, {});
  EXPECT_GT(found.motion.t.z(), 0.1);
  EXPECT_LT(found.motion.t.z(), 0.16);
}

TEST(TwoStep, TooLittleIsSaid) {
  const World w = world();
  const TwoStepResult none = two_step(seen(w, {}), {}, {}, {});
  EXPECT_FALSE(none.by_ground || none.by_edges);
}

}  // namespace
}  // namespace plumbline::slam::lego
