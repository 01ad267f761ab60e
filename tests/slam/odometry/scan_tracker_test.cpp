// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/scan_tracker.h"

#include <gtest/gtest.h>

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
  EXPECT_GT(second_sigma(100'000'000).least_bend_m, 0.0) << "followed from scan to scan";
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

}  // namespace
}  // namespace plumbline::slam
