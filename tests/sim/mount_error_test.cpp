// SPDX-License-Identifier: Apache-2.0
#include "sim/mount_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world.h"

namespace plumbline::sim {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(MountError, OfNothingTellsTheTruth) {
  const slam::Calibration truth = World::calibration(), told = told_calibration(truth, {}, 1);
  EXPECT_EQ(told.X_RL.t, truth.X_RL.t);
  EXPECT_EQ(told.X_RL.q.coeffs(), truth.X_RL.q.coeffs());
  EXPECT_EQ(told.sensor_height_m, truth.sensor_height_m);
}

TEST(MountError, TellsAMountThatIsOffByItsSizesInADrawnDirection) {
  const slam::Calibration truth = World::calibration();
  Eigen::Vector3d sum_R = Eigen::Vector3d::Zero(), turns = Eigen::Vector3d::Zero();
  constexpr int n = 400;
  for (std::uint64_t seed = 0; seed < n; ++seed) {
    MountError error;
    error.length_m = 0.01;
    error.angle_rad = 0.5 * degree;
    const slam::Calibration told = told_calibration(truth, error, seed);
    EXPECT_NEAR((told.X_RL.t - truth.X_RL.t).norm(), 0.01, 1e-12);
    EXPECT_NEAR(told.X_RL.q.angularDistance(truth.X_RL.q), 0.5 * degree, 1e-9);
    EXPECT_NEAR(told.sensor_height_m - truth.sensor_height_m, told.X_RL.t.z() - truth.X_RL.t.z(), 1e-12);
    sum_R += (told.X_RL.t - truth.X_RL.t) / 0.01;
    turns += log_so3(truth.X_RL.q.conjugate() * told.X_RL.q) / (0.5 * degree);
  }
  // A component of a random direction has variance 1/3; five standard errors.
  EXPECT_LT((sum_R / n).cwiseAbs().maxCoeff(), 5.0 / std::sqrt(3.0 * n));
  EXPECT_LT((turns / n).cwiseAbs().maxCoeff(), 5.0 / std::sqrt(3.0 * n));
}

TEST(MountError, GivenOnesAreTold) {
  MountError error;
  error.length_m = 0.5;
  error.offset_R = Eigen::Vector3d(0.01, 0.0, -0.02);
  error.rotation_L = Eigen::Vector3d(0.0, 0.0, 1.0 * degree);
  const slam::Calibration truth = World::calibration(), told = told_calibration(truth, error, 9);
  EXPECT_LT((told.X_RL.t - truth.X_RL.t - *error.offset_R).norm(), 1e-12);
  EXPECT_NEAR(told.X_RL.yaw(), 1.0 * degree, 1e-12);
}

}  // namespace
}  // namespace plumbline::sim
