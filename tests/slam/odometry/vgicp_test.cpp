// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/vgicp.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

// Through a door and back with noisy legs: the drift stays centimetres, and below that of the legs.
TEST(VgicpOdometryTest, FollowsAWalkThroughADoor) {
  synthetic::WalkConfig config;
  config.range_bias_m = 0.015;
  config.odometry_scale = 1.03;
  config.duration_s = 12.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  VgicpOdometry odometry({});
  MotionBuffer motion;
  for (const Odometry& record : recording.odometry) motion.add(record);
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  double worst = 0.0;
  double legs = 0.0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const Pose X_OR = motion.at(recording.scans[k].stamp);
    const Registration r = odometry.update(deskew(recording.scans[k], motion, recording.calibration), X_OR);
    const Pose X_MR = X_MW * recording.truth[k].X_FR;
    worst = std::max(worst, (r.X_MR.t - X_MR.t).norm());
    legs = std::max(legs, (X_OR.t - motion.at(recording.scans[0].stamp).t - X_MR.t).norm());
  }
  EXPECT_LT(worst, 0.15);
  EXPECT_LT(worst, 0.7 * legs);
}

}  // namespace
}  // namespace plumbline::slam
