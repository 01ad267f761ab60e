// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/extrapolation_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::slam {
namespace {

/// Turns to and fro by 0.1 rad, at 1 Hz.
Pose swaying(double t) { return Pose::from_xyz_yaw({0.5 * t, 0.0, 0.0}, 0.1 * std::sin(2.0 * M_PI * t)); }

/// The covariance after 4 s of scans at 10 Hz and odometry that is late.
Eigen::Matrix3d after_walk(Nanoseconds late, Pose (*pose)(double)) {
  MotionBuffer motion;
  motion.set_clock_offset(late, 0);
  ExtrapolationErrors errors;
  for (Nanoseconds t = 0; t <= 4'000'000'000; t += 10'000'000) {
    motion.add({t, pose(seconds(t - late))});
    if (t > 500'000'000 && t % 100'000'000 == 0) errors.add(t, motion.at(t), motion);
  }
  return errors.covariance();
}

TEST(ExtrapolationErrors, AreThoseOfTheVelocityThatWasCarriedOn) {
  // Of a sine: the yaw that follows from the rate between two records, against what it is.
  const double phase = 2.0 * M_PI * 0.1, between = 2.0 * M_PI * 0.01;
  double mean_square = 0.0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    const double a = 2.0 * M_PI * i / steps;
    const double rate = (std::sin(a) - std::sin(a - between)) / between;
    const double error = 0.1 * (std::sin(a + phase) - std::sin(a) - phase * rate);
    mean_square += error * error / steps;
  }
  const Eigen::Matrix3d covariance = after_walk(100'000'000, swaying);
  EXPECT_NEAR(covariance(2, 2) / mean_square, 1.0, 0.05);  // yaw goes along an arc, not a line
  EXPECT_LT(covariance(2, 2), after_walk(200'000'000, swaying)(2, 2));
}

TEST(ExtrapolationErrors, AreNoneOfEvenMotionNorInTime) {
  const auto even = [](double t) { return Pose::from_xyz_yaw({0.5 * t, 0.1 * t, 0.0}, 0.0); };
  EXPECT_LT(after_walk(200'000'000, even).norm(), 1e-12);
  EXPECT_LT(after_walk(0, swaying).norm(), 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
