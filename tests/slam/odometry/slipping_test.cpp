// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/slipping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "slam/odometry/front_end.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

Pose forward(double x_m, double y_m = 0.0) { return Pose::from_xyz_yaw({x_m, y_m, 0.0}, 0.0); }

Registration placed(double x_m) {
  Registration alone;
  alone.X_MR = forward(x_m);
  alone.matched = 0.9;
  return alone;
}

const ExpectedMotion continued(forward(0.07), 0.004, 0.01);

TEST(SlipWatch, DoubtsWhatTheMotionBeforeDoesNotExplain) {
  SlipWatch watch;
  EXPECT_FALSE(watch.doubts(forward(0.085), continued)) << "a gait's sway";
  EXPECT_TRUE(watch.doubts(forward(0.12), continued));
  EXPECT_TRUE(watch.doubts(forward(0.07, 0.05), continued)) << "to the side";
}

TEST(SlipWatch, BelievesAScanThatGoesOnAsBefore) {
  SlipWatch watch;
  EXPECT_TRUE(watch.shows_slip(placed(2.075), forward(2.0), forward(-0.07), continued, 0.95));
  EXPECT_FALSE(watch.shows_slip(placed(1.95), forward(2.0), forward(-0.07), continued, 0.95)) << "a push shows in both";
  Registration open = placed(2.075);
  open.unobserved_directions = 1;
  EXPECT_FALSE(watch.shows_slip(open, forward(2.0), forward(-0.07), continued, 0.95)) << "nothing tells the way";
  Registration poor = placed(2.075);
  poor.matched = 0.5;
  EXPECT_FALSE(watch.shows_slip(poor, forward(2.0), forward(-0.07), continued, 0.95)) << "the scan does not fit";
}

TEST(SlipWatch, DoubtsMoreWhileOdometrySlips) {
  SlipWatch watch;
  const ExpectedMotion shaken(forward(0.07), 0.03, 0.01);
  EXPECT_FALSE(watch.doubts(forward(0.0), shaken));
  ASSERT_TRUE(watch.shows_slip(placed(0.075), {}, forward(-0.07), shaken, 0.95));
  EXPECT_TRUE(watch.doubts(forward(0.0), shaken));
  watch.trust();
  EXPECT_FALSE(watch.doubts(forward(0.0), shaken));
}

/// In a corridor of which the end walls alone tell the way, and few surfels lie on them.
TEST(Slipping, FeetInACorridorDoNotMoveTheRobot) {
  synthetic::WalkConfig walk;
  walk.duration_s = 6.0;
  synthetic::Recording recording = synthetic::walk(synthetic::one_room(40.0, 2.4), {{4.0, 1.2}, {36.0, 1.2}}, walk);
  constexpr double slip_mps = 1.5, from_s = 3.0, to_s = 4.0;
  for (Odometry& record : recording.odometry)
    record.X_OR.t.x() -= slip_mps * std::clamp(seconds(record.stamp) - from_s, 0.0, to_s - from_s);
  FrontEnd front_end(LidarOdometryConfig{}, recording.calibration, true);
  const Pose X_MW = recording.truth.front().X_FR.inverse();
  std::size_t next = 0;
  double worst_m = 0.0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= recording.scans[k].stamp; ++next)
      front_end.on_odometry(recording.odometry[next]);
    DeskewedScan deskewed = front_end.deskewed(recording.scans[k]);
    const Registration found = front_end.track(recording.scans[k], deskewed);
    worst_m = std::max(worst_m, (found.X_MR.t - (X_MW * recording.truth[k].X_FR).t).norm());
  }
  EXPECT_LT(worst_m, 0.1) << "of 1.5 m";
}

}  // namespace
}  // namespace plumbline::slam
