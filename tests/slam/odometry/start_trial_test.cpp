// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/start_trial.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

LidarOdometryConfig lidar_alone() {
  LidarOdometryConfig config;
  config.vgicp.odometry_prior = config.vgicp.tilt_prior = false;
  return config;
}

synthetic::Recording driven_at(double speed_mps) {
  synthetic::House street = synthetic::one_room(80.0, 14.0);
  for (double x = 3.0; x < 80.0; x += 7.0)
    for (const double y : {2.0, 10.5}) street.boxes.push_back({{x, y, 0.0}, {x + 1.5, y + 1.5, 2.8}});
  synthetic::WalkConfig walk;
  walk.speed_mps = speed_mps;
  walk.duration_s = 1.2;
  walk.vibration = 0.0;
  return synthetic::walk(street, {{4.0, 7.0}, {78.0, 7.0}}, walk);
}

double error_m(const synthetic::Recording& recording, std::size_t k, const Registration& result) {
  return (result.X_MR.t - (recording.truth.front().X_FR.inverse() * recording.truth[k].X_FR).t).norm();
}

/// The start that a trial finds. crept: what the tracker gives is a standstill that fits badly.
void expect_start(double speed_mps, bool crept) {
  const synthetic::Recording recording = driven_at(speed_mps);
  ScanTracker tracker(lidar_alone(), recording.calibration, false);
  StartTrial trial(lidar_alone(), recording.calibration);
  std::optional<StartTrial::Tracked> better;
  std::size_t k = 0;
  for (; k < recording.scans.size() && !better; ++k) {
    DeskewedScan scan = tracker.deskewed(recording.scans[k]);
    Registration result = tracker.track(recording.scans[k], scan);
    if (crept && k > 0) result.X_MR = Pose{};
    if (crept && k > 0) result.matched = 0.3;
    better = trial.add(recording.scans[k], tracker, result);
  }
  ASSERT_EQ(better.has_value(), crept) << speed_mps << " m/s";
  if (!better) return;
  EXPECT_LT(error_m(recording, k - 1, better->result), 0.3) << speed_mps << " m/s";
  DeskewedScan next = better->tracker.deskewed(recording.scans[k]);
  const Registration result = better->tracker.track(recording.scans[k], next);
  EXPECT_TRUE(result.accepted);
  EXPECT_LT(error_m(recording, k, result), 0.3) << speed_mps << " m/s";
}

TEST(StartTrial, FindsTheVelocityOfAStartInMotion) {
  for (const double speed_mps : {5.0, 9.0}) expect_start(speed_mps, true);
}

TEST(StartTrial, LeavesAStartThatWasRight) {
  for (const double speed_mps : {0.3, 1.5, 9.0}) expect_start(speed_mps, false);
}

/// In a hall whose walls are far off, what matches more or less from another velocity says nothing of the way.
TEST(StartTrial, LeavesAStartOfWhichNoSurfaceTellsTheWay) {
  synthetic::House hall = synthetic::one_room(100.0, 80.0);
  hall.height_m = 10.0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    synthetic::WalkConfig walk;
    walk.seed = seed;
    walk.speed_mps = 0.1;
    walk.duration_s = 1.2;
    const synthetic::Recording recording = synthetic::walk(hall, {{30.0, 40.0}, {60.0, 40.0}}, walk);
    ScanTracker tracker(lidar_alone(), recording.calibration, false);
    StartTrial trial(lidar_alone(), recording.calibration);
    for (const Scan& raw : recording.scans) {
      DeskewedScan scan = tracker.deskewed(raw);
      Registration result = tracker.track(raw, scan);
      result.matched *= 0.5;  // so that any other start matches more
      const std::optional<StartTrial::Tracked> better = trial.add(raw, tracker, result);
      ASSERT_FALSE(better) << seed << ": " << better->result.X_MR.t.transpose();
    }
  }
}

TEST(StartTrial, TriesNothingBeforeAMapBegins) {
  const synthetic::Recording recording = driven_at(5.0);
  const ScanTracker tracker(lidar_alone(), recording.calibration, false);
  StartTrial trial(lidar_alone(), recording.calibration);
  for (const Scan& scan : recording.scans) EXPECT_FALSE(trial.add(scan, tracker, Registration{}).has_value());
}

}  // namespace
}  // namespace plumbline::slam
