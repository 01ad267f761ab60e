// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/motion_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

constexpr Nanoseconds period = 100'000'000;

Pose screw(double x, double yaw) {
  Vector6d xi = Vector6d::Zero();
  xi(0) = x;
  xi(5) = yaw;
  return exp_se3(xi);
}

TEST(MotionPrediction, KnowsNothingBeforeTheFirstStep) {
  MotionPrediction prediction;
  EXPECT_FALSE(prediction.over(period));
  prediction.add(screw(0.1, 0.05), period);
  ASSERT_TRUE(prediction.over(period));
  EXPECT_LT(log_se3(prediction.over(period)->inverse() * screw(0.1, 0.05)).norm(), 1e-12);
  EXPECT_LT(log_se3(prediction.over(period / 2)->inverse() * screw(0.05, 0.025)).norm(), 1e-12);
  // The rotation for three steps at most; the way, at 1 m/s, for 0.5 s.
  Vector6d farther = log_se3(screw(0.1, 0.05));
  farther.head<3>() *= 5.0;
  farther.tail<3>() *= 3.0;
  EXPECT_LT(log_se3(prediction.over(50 * period)->inverse() * exp_se3(farther)).norm(), 1e-12);
  prediction.clear();
  EXPECT_FALSE(prediction.over(period));
}

/// Root mean square of the predictions' rotation errors over a motion.
template <class Yaw>
double error_of(const Yaw& yaw) {
  MotionPrediction prediction;
  double squared = 0.0;
  constexpr int steps = 200, settled = 30;
  for (int k = 0; k < steps; ++k) {
    const Pose step = screw(0.06, yaw(k));
    if (k >= settled) squared += std::pow(log_so3(prediction.over(period)->q.conjugate() * step.q).norm(), 2);
    prediction.add(step, period);
  }
  return std::sqrt(squared / (steps - settled));
}

// A vehicle's turn: the last step says most. A shaking body: its mean does, and to go on as it last did would double
// the error (that of the last step: sqrt(2) sigma).
TEST(MotionPrediction, FollowsATurnAndIgnoresShaking) {
  EXPECT_LT(error_of([](int k) { return 0.1 * std::sin(0.1 * k); }), 0.012);
  const Stream random(41, "bim.generate");
  constexpr double sigma = 0.05;
  EXPECT_LT(error_of([&](int k) { return sigma * random.gauss(static_cast<std::uint64_t>(k), 0); }), 1.15 * sigma);
}

}  // namespace
}  // namespace plumbline::slam
