// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "slam/odometry/front_end.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct WalkedFar {
  double worst_m = 0.0;  ///< farthest from the truth
  int lost = 0, degenerate = 0, scans = 0;
};

/// LiDAR alone in a bare house of this size, from its middle, the way from there given.
WalkedFar walk_alone(const Eigen::Vector2d& size, double height_m, const std::vector<Eigen::Vector2d>& way,
                     double duration_s) {
  synthetic::House house = synthetic::one_room(size.x(), size.y());
  house.height_m = height_m;
  for (synthetic::Box& wall : house.boxes) wall.max.z() = height_m;
  std::vector<Eigen::Vector2d> waypoints;
  for (const Eigen::Vector2d& point : way) waypoints.push_back(0.5 * size + point);
  synthetic::WalkConfig walk;
  walk.duration_s = duration_s;
  walk.vibration = 0.3;
  const synthetic::Recording recording = synthetic::walk(house, waypoints, walk);
  LidarOdometryConfig config;
  config.vgicp.odometry_prior = config.vgicp.tilt_prior = false;
  FrontEnd front_end(config, recording.calibration, false);
  WalkedFar result;
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    DeskewedScan scan = front_end.deskewed(recording.scans[k]);
    const Registration found = front_end.track(recording.scans[k], scan);
    result.worst_m = std::max(result.worst_m, (found.X_MR.t - (X_MW * recording.truth[k].X_FR).t).norm());
    result.lost += found.lost ? 1 : 0;
    result.degenerate += found.degenerate_directions > 0 ? 1 : 0;
    ++result.scans;
  }
  return result;
}

const std::vector<Eigen::Vector2d> round_a_corner = {{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}};

// Most returns are of the floor around; what tells the way is 40 to 50 m away.
TEST(FarWalls, OfABareHallTellTheWay) {
  const WalkedFar walked = walk_alone({100.0, 80.0}, 9.0, round_a_corner, 6.0);
  ASSERT_GT(walked.scans, 50);
  EXPECT_LT(walked.worst_m, 0.1);
  EXPECT_EQ(walked.lost, 0);
  EXPECT_EQ(walked.degenerate, 0);
}

// The same where all of them are out of range.
TEST(FarWalls, OutOfRangeLeaveTheRobotLost) {
  const WalkedFar walked = walk_alone({420.0, 400.0}, 30.0, round_a_corner, 6.0);
  ASSERT_GT(walked.scans, 50);
  EXPECT_GT(walked.degenerate, 45);
  EXPECT_GT(walked.lost, 25);
}

}  // namespace
}  // namespace plumbline::slam
