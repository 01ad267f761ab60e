// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/adaptive_threshold.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::slam::kiss {
namespace {

constexpr double initial_m = 2.0, min_motion_m = 0.1, max_range_m = 50.0;

Pose deviation(double translation_m, double angle_rad) {
  return {exp_so3(angle_rad * Eigen::Vector3d(1.0, -2.0, 2.0) / 3.0),
          translation_m * Eigen::Vector3d(2.0, 3.0, -6.0) / 7.0};
}

TEST(AdaptiveThreshold, IsTheRootMeanSquareOfDeviations) {
  AdaptiveThreshold threshold(initial_m, min_motion_m, max_range_m);
  EXPECT_EQ(threshold.sigma_m(), initial_m);
  double sum = initial_m * initial_m;
  int count = 1;
  const double deviations[][2] = {{0.3, 0.0}, {0.0, 0.01}, {0.2, 0.03}, {0.0, 3.1}, {0.11, 0.0}};
  for (const auto& [translation_m, angle_rad] : deviations) {
    threshold.add(deviation(translation_m, angle_rad));
    sum += std::pow(translation_m + 2.0 * max_range_m * std::sin(0.5 * angle_rad), 2);
    EXPECT_NEAR(threshold.sigma_m(), std::sqrt(sum / ++count), 1e-12);
  }
}

TEST(AdaptiveThreshold, SmallDeviationsDoNotCount) {
  AdaptiveThreshold threshold(initial_m, min_motion_m, max_range_m);
  for (int k = 0; k < 100; ++k) threshold.add(deviation(0.04, 0.001));  // 0.09 m together
  EXPECT_EQ(threshold.sigma_m(), initial_m);
  threshold.add(deviation(0.06, 0.001));
  EXPECT_NEAR(threshold.sigma_m(), std::sqrt((4.0 + 0.11 * 0.11) / 2.0), 1e-8);
}

}  // namespace
}  // namespace plumbline::slam::kiss
