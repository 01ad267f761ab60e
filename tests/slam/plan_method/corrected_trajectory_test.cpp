// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/corrected_trajectory.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

TEST(CorrectedTrajectory, CarriesTheFirstCorrectionBackAndInterpolatesBetween) {
  CorrectedTrajectory trail;
  for (int i = 0; i < 5; ++i) trail.add_scan(i, Pose{Eigen::Quaterniond::Identity(), {1.0 * i, 0.0, 0.0}});
  EXPECT_TRUE(trail.poses(Pose{}).empty());
  trail.add_correction(1, Pose::from_xyz_yaw({0.0, 2.0, 0.0}, 0.0));
  trail.add_correction(3, Pose::from_xyz_yaw({0.0, 3.0, 0.0}, 0.0));
  const std::vector<StampedPose> poses = trail.poses(Pose{});
  ASSERT_EQ(poses.size(), 5U);
  EXPECT_NEAR(poses[0].X_FR.t.y(), 2.0, 1e-12);
  EXPECT_NEAR(poses[2].X_FR.t.y(), 2.5, 1e-12);
  EXPECT_NEAR(poses[4].X_FR.t.y(), 3.0, 1e-12);
  EXPECT_NEAR(poses[4].X_FR.t.x(), 4.0, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
