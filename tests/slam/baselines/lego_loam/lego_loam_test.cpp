// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/lego_loam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/random/stream.h"
#include "tests/slam/baselines/house_walk.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

// Rings at -15 to -1 deg meet this floor from 2.5 m on: little ground indoors. Measured: 13 cm across and 59 cm of
// height; indoor 14 and 33.
TEST(LegoLoam, FollowsAWalk) {
  const auto plain = make_lego_loam(synthetic::robot(), {});
  const synthetic::WorstError reference = synthetic::worst_in_house(*plain, 10.0);
  EXPECT_LT(reference.across_m, 0.18);
  EXPECT_LT(reference.height_m, 0.75);
  const auto for_rooms = make_lego_loam(synthetic::robot(), LegoLoamIndoorConfig());
  const synthetic::WorstError indoor = synthetic::worst_in_house(*for_rooms, 10.0);
  EXPECT_LT(indoor.across_m, 0.18);
  EXPECT_LT(indoor.height_m, 0.45);
}

TEST(LegoLoam, FollowsAWalkByScansWithoutRings) {
  const auto method = make_lego_loam(synthetic::robot(), LegoLoamIndoorConfig());
  const synthetic::WorstError worst = synthetic::worst_in_house(*method, 10.0, false);
  EXPECT_LT(worst.across_m, 0.18);
  EXPECT_LT(worst.height_m, 0.45);
}

/// Seen from (x, 5) of a room, without what lies below the LiDAR.
Scan without_a_floor(double x, int tenths_s) {
  Scan scan = synthetic::standing_scan(synthetic::one_room(12.0, 10.0), Pose::from_xyz_yaw({x, 5.0, 0.46}, 0.0), {});
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.point_L[i].z() < 0.0) scan.range_m[i] = 0.0;
  scan.stamp += 100'000'000 * tenths_s;
  return scan;
}

// The map is asked each 0.3 s.
TEST(LegoLoam, WithoutAFloorItSaysSo) {
  const auto method = make_lego_loam(synthetic::robot(), {});
  for (int k = 0; k < 3; ++k) {
    const Output output = method->on_scan(without_a_floor(6.0, k));
    EXPECT_EQ(output.state, k == 0 ? State::converged : State::lost);
    EXPECT_LT(output.X_FR->t.norm(), 0.02);
  }
}

TEST(LegoLoam, WithoutAFloorTheMapTellsThePose) {
  const auto method = make_lego_loam(synthetic::robot(), {});
  for (int k = 0; k < 8; ++k) {
    const Output output = method->on_scan(without_a_floor(6.0 + 0.2 * k, 3 * k));
    EXPECT_EQ(output.state, State::converged) << k;
    EXPECT_LT((output.X_FR->t - Eigen::Vector3d(0.2 * k, 0.0, 0.0)).head<2>().norm(), 0.1) << k;
  }
}

TEST(LegoLoam, WhatEdgesAloneTellIsKept) {
  const auto method = make_lego_loam(synthetic::robot(), {});
  for (int k = 0; k < 2; ++k) {
    const Output output = method->on_scan(without_a_floor(6.0 + 0.1 * k, k));
    EXPECT_EQ(output.state, k == 0 ? State::converged : State::lost);
    EXPECT_NEAR(output.X_FR->t.x(), 0.1 * k, 0.05);
    EXPECT_NEAR(output.X_FR->t.z(), 0.0, 1e-9);
  }
}

TEST(LegoLoam, WithoutReturnsThePoseStands) {
  const auto method = make_lego_loam(synthetic::robot(), {});
  EXPECT_EQ(method->on_scan(without_a_floor(6.0, 0)).state, State::converged);
  for (int k = 1; k < 8; ++k) {
    Scan scan = without_a_floor(6.0, k);
    scan.range_m.assign(scan.size(), 0.0);
    const Output output = method->on_scan(scan);
    EXPECT_EQ(output.state, State::lost) << k;
    EXPECT_EQ(output.X_FR->t, Eigen::Vector3d::Zero()) << k;
  }
}

// Upwards the reference's steps are the loosest.
TEST(LegoLoam, StepsOfTheGraphWeighAsInTheReference) {
  const auto method = make_lego_loam(synthetic::robot(), LegoLoamIndoorConfig());
  (void)synthetic::worst_in_house(*method, 4.0);
  const Tree graph = method->finish().graph;
  const Tree* factors = graph.find("pose_factors");
  ASSERT_NE(factors, nullptr);
  ASSERT_FALSE(factors->as_list().empty());
  const Tree* upper = factors->as_list().front().find("information");
  ASSERT_NE(upper, nullptr);
  // The diagonal of the upper triangle, row by row: x, y, z, then rotations.
  const double expected[] = {1e8, 1e8, 1e6, 1e6, 1e6, 1e6};
  for (std::size_t k = 0, i = 0; k < 6; i += 6 - k, ++k) EXPECT_EQ(upper->as_list()[i].as_double(), expected[k]) << k;
}

/// Clutter about a corner of the square, seen from X_WR.
loam::MapFeatures view(const std::vector<Eigen::Vector3d>& world_W, const Pose& X_WR) {
  loam::MapFeatures features;
  for (const Eigen::Vector3d& p_W : world_W)
    if ((p_W - X_WR.t).norm() < 12.0) features.flats_R.push_back(X_WR.inverse() * p_W);
  return features;
}

// A square of 20 m whose way is measured half a per cent too long, and with 0.2 deg too much of each turn.
TEST(LegoLoop, ClosesASquare) {
  const Stream stream(5, "bim.generate");
  std::vector<Eigen::Vector3d> world_W;
  for (std::uint32_t i = 0; i < 6000; ++i)
    world_W.emplace_back(40.0 * stream.uniform(0, i, 0) - 10.0, 40.0 * stream.uniform(0, i, 1) - 10.0,
                         3.0 * stream.uniform(0, i, 2));
  loam::KeyframeMap map({});
  std::vector<Nanoseconds> stamps;
  Pose X_WR, X_MR;
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < 20; ++k) {
      map.add(X_MR, view(world_W, X_WR));
      stamps.push_back(static_cast<Nanoseconds>(stamps.size()) * 1'000'000'000);
      const double turn = k == 19 ? 1.5708 : 0.0;
      X_WR = X_WR * Pose::from_xyz_yaw({1.0, 0.0, 0.0}, turn);
      X_MR = X_MR * Pose::from_xyz_yaw({1.005, 0.0, 0.0}, turn > 0.0 ? turn + 0.0035 : 0.0);
    }
  map.add(X_MR, view(world_W, X_WR));
  stamps.push_back(static_cast<Nanoseconds>(stamps.size()) * 1'000'000'000);
  EXPECT_GT((X_MR.t - X_WR.t).norm(), 0.1);
  lego::LoopConfig config;
  config.on = true;
  // Correspondences from farther pull a cloud of single points towards its middle.
  const std::optional<lego::Loop> loop = lego::find_loop(map, stamps, config);
  ASSERT_TRUE(loop.has_value());
  EXPECT_EQ(loop->keyframe, 0U);
  EXPECT_LT((loop->X_FT.t - X_WR.t).norm(), 0.05);
}

TEST(LegoLoop, NeedsTimeAndNearness) {
  loam::KeyframeMap map({});
  const std::vector<Eigen::Vector3d> world_W = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0},
                                                {0, 2, 0}, {0, 0, 2}, {1, 1, 1}};
  std::vector<Nanoseconds> stamps;
  const auto add = [&](double x, double t_s) {
    map.add(Pose::from_xyz_yaw({x, 0, 0}, 0), view(world_W, Pose::from_xyz_yaw({x, 0, 0}, 0)));
    stamps.push_back(static_cast<Nanoseconds>(t_s * 1e9));
  };
  add(0.0, 0.0);
  add(0.1, 29.0);
  EXPECT_FALSE(lego::find_loop(map, stamps, {}).has_value());
  add(7.5, 40.0);
  EXPECT_FALSE(lego::find_loop(map, stamps, {}).has_value());
}

}  // namespace
}  // namespace plumbline::slam
