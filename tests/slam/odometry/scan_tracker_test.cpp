// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/scan_tracker.h"

#include <gtest/gtest.h>

#include <vector>

#include "bim/median.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// What is not known of the motion during the second of two sweeps that follow one another, without odometry.
TwistSigma second_sigma(Nanoseconds period) {
  Scan scan = synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({2.9, 1.9, 0.5}, 0.3), {});
  scan.offset_ns.assign(scan.size(), 0);
  for (std::size_t i = 0; i < scan.size(); ++i)
    scan.offset_ns[i] = static_cast<int>(period * static_cast<Nanoseconds>(i) / static_cast<Nanoseconds>(scan.size())) -
                        static_cast<int>(period);
  ScanTracker tracker({}, synthetic::calibration(), false);
  scan.stamp = period;
  DeskewedScan first = tracker.deskewed(scan);
  (void)tracker.track(scan, first);
  scan.stamp = 2 * period;
  return tracker.deskewed(scan).twist_sigma;
}

// A hand swings a LiDAR within 0.2 s so that the mean motion says too little. In a stairwell with 64 rings at 5 Hz the
// pose was lost for it.
TEST(ScanTracker, KnowsLessOfTheMotionDuringLongSweeps) {
  EXPECT_NEAR(second_sigma(50'000'000).radps, 0.1, 1e-6);
  EXPECT_NEAR(second_sigma(100'000'000).radps, 0.2, 1e-6);
  EXPECT_NEAR(second_sigma(200'000'000).radps, 0.4, 1e-6);
  EXPECT_NEAR(second_sigma(200'000'000).mps, 0.2, 1e-6);
  EXPECT_NEAR(second_sigma(500'000'000).radps, 1.0, 1e-6);
  EXPECT_EQ(second_sigma(100'000'000).least_bend_m, 0.0) << "also where one scan follows the other";
}

TEST(ScanTracker, ACopyGoesOnByItself) {
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), {.duration_s = 1.0});
  ScanTracker tracker({}, recording.calibration, false);
  const auto track = [&](ScanTracker& by, std::size_t k) {
    DeskewedScan scan = by.deskewed(recording.scans[k]);
    return by.track(recording.scans[k], scan).X_MR;
  };
  for (std::size_t k = 0; k < 4; ++k) (void)track(tracker, k);
  ScanTracker copy(tracker);
  const Pose by_copy = track(copy, 4);
  (void)track(copy, 5);
  const Pose by_tracker = track(tracker, 4);
  EXPECT_EQ(by_copy.t, by_tracker.t);
  EXPECT_EQ(by_copy.q.coeffs(), by_tracker.q.coeffs());
}

/// Median error of the rotation from scan to scan, rad, of LiDAR alone at 10 Hz, swayed as in a hand.
double step_error_in_a_hand(std::uint64_t seed) {
  synthetic::WalkConfig config{.seed = seed, .duration_s = 5.0};
  config.vibration = 8.0;  // 6 degrees of roll, 5 of pitch, 5 cm
  const std::vector<Eigen::Vector2d> way = synthetic::corridor_house_walk();
  const synthetic::Recording recording = synthetic::walk(synthetic::corridor_house(), way, config);
  ScanTracker tracker({}, recording.calibration, false);
  std::vector<double> errors;
  Pose X_MR, X_WR;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    DeskewedScan deskewed = tracker.deskewed(recording.scans[k]);
    const Pose now = tracker.track(recording.scans[k], deskewed).X_MR, truth = recording.truth[k].X_FR;
    errors.push_back(log_so3((X_WR.inverse() * truth).q.conjugate() * (X_MR.inverse() * now).q).norm());
    X_MR = now;
    X_WR = truth;
  }
  return median(errors);
}

// Half of the error in corridors that were carried by hand was that of the mean motion between two scans. Here it is
// 0.044 to 0.051 rad without the correction, 0.024 to 0.029 with it.
TEST(ScanTracker, CorrectsTheSwayOfAHandWithinASweep) {
  EXPECT_LT(step_error_in_a_hand(1), 0.035);
  EXPECT_LT(step_error_in_a_hand(2), 0.035);
}

}  // namespace
}  // namespace plumbline::slam
