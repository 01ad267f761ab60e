// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_gaps.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

/// Ten scans a second for 4 s, with a record at each but in a gap.
std::optional<std::string> warning_of(double from_s, double to_s) {
  OdometryGaps gaps;
  for (int k = 0; k <= 40; ++k) {
    slam::SensorFrame frame;
    frame.scan.stamp = k * slam::Nanoseconds{100'000'000};
    if (0.1 * k < from_s || 0.1 * k > to_s) frame.odometry.push_back({frame.scan.stamp, Pose{}});
    gaps.add(frame);
  }
  return gaps.warning();
}

TEST(OdometryGaps, AreSaid) {
  EXPECT_FALSE(warning_of(9.0, 9.0));
  EXPECT_FALSE(warning_of(1.05, 1.45)) << "half a second is no gap";
  EXPECT_EQ(warning_of(1.05, 2.05), "odometry is more than 0.5 s old at 5 of 41 scans, first at 1.6 s");
  EXPECT_EQ(warning_of(3.05, 9.0),
            "odometry is more than 0.5 s old at 5 of 41 scans, first at 3.6 s, and ends before the last scan");
}

}  // namespace
}  // namespace plumbline::scenarios
