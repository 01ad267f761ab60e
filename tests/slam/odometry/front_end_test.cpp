// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/front_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

LidarOdometryConfig alone() {
  LidarOdometryConfig config;
  config.vgicp.odometry_prior = config.vgicp.tilt_prior = false;
  return config;
}

struct Tracked {
  double worst_m = 0.0;  ///< farthest from the truth
  bool ever_lost = false;
  int degenerate = 0;  ///< scans
  double highest_m = 0.0;
};

/// LiDAR alone along a way, by every nth scan; `rings`: false strips the scans of their order and times.
Tracked track(const synthetic::House& house, const std::vector<Eigen::Vector2d>& way, double speed_mps,
              double duration_s, std::size_t nth, bool rings) {
  synthetic::WalkConfig walk;
  walk.speed_mps = speed_mps;
  walk.duration_s = duration_s;
  walk.vibration = 0.3;
  const synthetic::Recording recording = synthetic::walk(house, way, walk);
  FrontEnd front_end(alone(), recording.calibration, false);
  Tracked result;
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  for (std::size_t k = 0; k < recording.scans.size(); k += nth) {
    Scan scan = recording.scans[k];
    scan.stamp += 1'000'000'000'000;  // a clock that did not start with the walk
    if (!rings) {
      scan.columns *= scan.rings;
      scan.rings = 1;
    }
    DeskewedScan deskewed = front_end.deskewed(scan);
    const Registration odometry = front_end.track(scan, deskewed);
    const Eigen::Vector3d error = odometry.X_MR.t - (X_MW * recording.truth[k].X_FR).t;
    result.worst_m = std::max(result.worst_m, error.norm());
    result.highest_m = std::max(result.highest_m, std::abs(error.z()));
    result.ever_lost |= odometry.lost;
    result.degenerate += odometry.degenerate_directions > 0 ? 1 : 0;
  }
  return result;
}

TEST(FrontEnd, LidarAloneWalksThroughTheHouse) {
  const Tracked walked = track(synthetic::corridor_house(), synthetic::corridor_house_walk(), 0.6, 12.0, 1, true);
  EXPECT_LT(walked.worst_m, 0.15);
  EXPECT_FALSE(walked.ever_lost);
}

TEST(FrontEnd, FewScansASecondAndFastOnes) {
  EXPECT_LT(track(synthetic::corridor_house(), synthetic::corridor_house_walk(), 0.6, 12.0, 5, true).worst_m, 0.25);
  EXPECT_LT(track(synthetic::one_room(12.0, 8.0), {{1.5, 1.5}, {10.0, 6.0}}, 3.0, 3.0, 1, true).worst_m, 0.25);
}

TEST(FrontEnd, WithoutRingsSurfelsComeFromVoxels) {
  const Tracked walked = track(synthetic::corridor_house(), synthetic::corridor_house_walk(), 0.6, 8.0, 1, false);
  EXPECT_LT(walked.worst_m, 0.25);
  EXPECT_FALSE(walked.ever_lost);
}

// Nothing tells how far the robot goes along walls that do not end; it says so, and does not fly off.
TEST(FrontEnd, AnEndlessCorridorIsDegenerateAndLost) {
  synthetic::House corridor = synthetic::one_room(300.0, 2.2);
  const Tracked walked = track(corridor, {{140.0, 1.1}, {160.0, 1.1}}, 0.8, 8.0, 1, true);
  EXPECT_GT(walked.degenerate, 40);
  EXPECT_TRUE(walked.ever_lost);
  EXPECT_LT(walked.highest_m, 0.3);
}

}  // namespace
}  // namespace plumbline::slam
