// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumbline::scenarios {
namespace {

/// Four seconds of odometry at 10 Hz that turns by `odometry` rad/s to and fro, and a gyro that says `gyro`.
std::vector<std::string> warnings_of(double odometry, double gyro, const Pose& start = {}, double scale = 1.0,
                                     int stops_at = 100) {
  constexpr double dt = 0.1;
  OdometryAxes axes;
  Pose X = start;
  for (int k = 1; k <= 40; ++k) {
    const double sign = k % 20 < 10 ? 1.0 : -1.0;
    if (k < stops_at) X = X * Pose::from_xyz_yaw({scale * 0.05, 0.0, 0.0}, sign * odometry * dt);
    slam::SensorFrame frame;
    frame.scan.stamp = k * slam::Nanoseconds{100'000'000};
    frame.odometry.push_back({frame.scan.stamp, X});
    for (int i = 1; i <= 10; ++i)
      frame.imu.push_back({frame.scan.stamp + (i - 10) * slam::Nanoseconds{10'000'000},
                           Eigen::Vector3d(0.0, 0.0, sign * gyro), Eigen::Vector3d(0.0, 0.0, 9.81)});
    axes.add(frame);
  }
  return axes.warnings();
}

TEST(OdometryAxes, ThatAreRightAreNotMentioned) {
  EXPECT_TRUE(warnings_of(0.5, 0.5).empty());
  EXPECT_TRUE(warnings_of(0.5, 0.0).empty()) << "no gyro";
  EXPECT_TRUE(warnings_of(0.01, -0.01).empty()) << "hardly a turn";
  EXPECT_TRUE(warnings_of(0.5, 0.5, {Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY())), {}}).empty())
      << "a ramp";
}

TEST(OdometryAxes, ThatTurnAgainstTheGyroAreSaid) {
  const std::vector<std::string> warnings = warnings_of(0.5, -0.5);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("odometry turns against the gyro", 0), 0U) << warnings[0];
}

TEST(OdometryAxes, AGyroInDegreesIsSaid) {
  const std::vector<std::string> warnings = warnings_of(0.5, 0.5 * 180.0 / std::numbers::pi);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("the gyro turns 57 times as fast as odometry", 0), 0U) << warnings[0];
  EXPECT_TRUE(warnings_of(0.5, 1.0).empty()) << "a gyro of another scale is none in degrees";
}

TEST(OdometryAxes, CentimetresAndAStandstillAreSaid) {
  for (const double scale : {200.0, 1000.0}) {
    const std::vector<std::string> warnings = warnings_of(0.5, 0.5, {}, scale);
    ASSERT_EQ(warnings.size(), 1U) << scale;
    EXPECT_NE(warnings[0].find("centimetres or millimetres"), std::string::npos) << warnings[0];
  }
  EXPECT_TRUE(warnings_of(0.5, 0.5, {}, 60.0).empty()) << "a car on a motorway";
  const std::vector<std::string> warnings = warnings_of(0.5, 0.5, {}, 1.0, 15);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("odometry does not change for 3 s, to 4 s after", 0), 0U) << warnings[0];
  EXPECT_TRUE(warnings_of(0.5, 0.0, {}, 1.0, 15).empty()) << "the robot stands";
}

TEST(OdometryAxes, ThatDoNotPointUpAreSaid) {
  const Pose down{Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())), {}};
  const std::vector<std::string> warnings = warnings_of(0.5, 0.5, down);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("odometry starts with the robot tilted by 180 degrees", 0), 0U) << warnings[0];
}

}  // namespace
}  // namespace plumbline::scenarios
