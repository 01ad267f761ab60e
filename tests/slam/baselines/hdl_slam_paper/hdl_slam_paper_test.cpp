// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/hdl_slam_paper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/slam/baselines/house_walk.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

TEST(HdlOdometry, HalfTheAngleCounts) {
  const hdl::OdometryConfig config;
  EXPECT_FALSE(hdl::odometry_keyframe_is_due(Pose::from_xyz_yaw({0.24, 0, 0}, 1.9), config));
  EXPECT_TRUE(hdl::odometry_keyframe_is_due(Pose::from_xyz_yaw({0.24, 0, 0}, 2.1), config));
  EXPECT_TRUE(hdl::odometry_keyframe_is_due(Pose::from_xyz_yaw({0.26, 0, 0}, 0.0), config));
}

TEST(HdlSlamPaper, AtRestTheGraphDoesNotGrow) {
  const auto method = make_hdl_slam_paper(synthetic::robot(), {});
  const synthetic::House house = synthetic::corridor_house();
  for (int k = 0; k < 12; ++k) {
    Scan scan = synthetic::standing_scan(house, Pose::from_xyz_yaw({3.0, 1.0, 0.46}, 0.2),
                                         {.seed = static_cast<std::uint64_t>(k + 1), .vibration = 0.0});
    scan.stamp += 100'000'000 * k;
    const Output output = method->on_scan(scan);
    EXPECT_EQ(output.state, State::converged);
    EXPECT_LT(output.X_FR->t.head<2>().norm(), 0.05);
  }
  const Estimate estimate = method->finish();
  EXPECT_EQ(estimate.graph.find("keyframes")->as_list().size(), 1U);
  EXPECT_TRUE(estimate.loops->empty());
}

// Single scans of 16 rings, not deskewed: some per cent of 7 m.
TEST(HdlSlamPaper, FollowsAWalk) {
  const auto method = make_hdl_slam_paper(synthetic::robot(), {});
  EXPECT_LT(synthetic::worst_in_house(*method, 12.0).across_m, 0.5);
}

TEST(HdlSlamPaper, WithoutReturnsItSaysSo) {
  const auto method = make_hdl_slam_paper(synthetic::robot(), {});
  Scan empty;
  empty.stamp = 100;
  EXPECT_EQ(method->on_scan(empty).state, State::lost);
  const Scan scan = synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({3.0, 2.0, 0.46}, 0.0), {});
  EXPECT_EQ(method->on_scan(scan).state, State::converged);
  Scan again = empty;
  again.stamp = scan.stamp + 100'000'000;
  EXPECT_EQ(method->on_scan(again).state, State::lost);
}

}  // namespace
}  // namespace plumbline::slam
