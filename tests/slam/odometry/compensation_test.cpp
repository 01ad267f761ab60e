// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/compensation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/geometry/pose.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// A scan of a robot that goes on evenly by `step` while it is made, raw or with that undone.
Scan moving_scan(const Pose& step, bool compensated) {
  Scan scan = synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({3.0, 2.0, 0.46}, 0.3), {});
  const double sweep_ns = -static_cast<double>(scan.offset_ns.front());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.range_m[i] <= 0.0) continue;
    // Where the head points is where the standing robot's did; what is hit lies elsewhere, which only deskewing shows.
    if (compensated)
      scan.point_L[i] = interpolate(Pose{}, step, static_cast<double>(scan.offset_ns[i]) / sweep_ns) * scan.point_L[i];
  }
  return scan;
}

TEST(CompensationTest, TellsRawCloudsFromDeskewedOnes) {
  for (const double way : {0.06, 0.3, 1.4})
    for (const double yaw : {0.0, 0.1}) {
      const Pose step = Pose::from_xyz_yaw({way, 0.3 * way, 0.0}, yaw);
      const Eigen::Vector3d velocity = step.t / 0.1;
      CompensationTest raw, deskewed;
      for (int k = 0; k < 3; ++k) {
        raw.add(moving_scan(step, false), velocity);
        deskewed.add(moving_scan(step, true), velocity);
      }
      for (int k = 0; k < 200 && !raw.is_settled(); ++k) raw.add(moving_scan(step, false), velocity);
      EXPECT_TRUE(raw.is_settled()) << way << " " << yaw;
      EXPECT_FALSE(raw.compensated()) << way << " " << yaw;
      EXPECT_TRUE(deskewed.compensated()) << way << " " << yaw;
    }
}

// As of drivers that turn clouds of a tilted LiDAR into the robot's axes.
TEST(CompensationTest, TellsThemInAFrameTiltedAgainstTheHead) {
  const Pose step = Pose::from_xyz_yaw({0.06, 0.02, 0.0}, 0.02);
  const Eigen::Vector3d velocity = step.t / 0.1;
  for (const double tilt : {-0.5, -0.1, 0.1, 0.5, 1.5, 3.1})
    for (const double about : {0.0, 0.8, 1.6, 2.4}) {
      const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0.0);
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(tilt, axis));
      CompensationTest raw, deskewed;
      for (const bool compensated : {false, true}) {
        Scan scan = moving_scan(step, compensated);
        for (Eigen::Vector3d& p : scan.point_L) p = turn * p;
        CompensationTest& test = compensated ? deskewed : raw;
        for (int k = 0; k < 200 && !test.is_settled(); ++k) test.add(scan, turn * velocity);
        EXPECT_TRUE(test.is_settled()) << tilt << " about " << about;
      }
      EXPECT_FALSE(raw.compensated()) << tilt << " about " << about;
      EXPECT_TRUE(deskewed.compensated()) << tilt << " about " << about;
    }
}

TEST(CompensationTest, SaysNothingOfARobotAtRestNorOfScansWithoutTimes) {
  CompensationTest test;
  const Pose step = Pose::from_xyz_yaw({1.0, 0.0, 0.0}, 0.0);
  test.add(moving_scan(step, true), Eigen::Vector3d::Zero());
  Scan untimed = moving_scan(step, true);
  std::fill(untimed.offset_ns.begin(), untimed.offset_ns.end(), 0);
  test.add(untimed, {10.0, 0.0, 0.0});
  test.add(Scan{}, {10.0, 0.0, 0.0});
  EXPECT_FALSE(test.compensated());
  EXPECT_FALSE(test.is_settled());
}

}  // namespace
}  // namespace plumbline::slam
