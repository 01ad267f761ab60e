// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/step_changes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

TEST(StepChanges, AreNoneOfASteadyRobot) {
  StepChanges changes;
  const Pose step = Pose::from_xyz_yaw({0.06, 0.01, 0.0}, 0.02);
  Pose X_MR;
  for (int i = 0; i < 50; ++i) {
    changes.add(X_MR);
    X_MR = X_MR * step;
  }
  EXPECT_LT(changes.covariance().norm(), 1e-20);
}

// A second difference of independent errors has 6 times their variance, a quarter of which is reported.
TEST(StepChanges, TellIndependentErrorsOfTheEnds) {
  const double sigma_m = 0.01, sigma_rad = 0.008;
  const Stream stream(3, "slam.localize.init");
  StepChanges changes;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  constexpr std::uint32_t scans = 20000;
  for (std::uint32_t i = 0; i < scans; ++i) {
    changes.add(Pose::from_xyz_yaw({sigma_m * stream.gauss(0, i, 0), sigma_m * stream.gauss(0, i, 1), 0.0},
                                   sigma_rad * stream.gauss(0, i, 2)));
    mean += changes.covariance().diagonal() / scans;
  }
  // Of 20,000 differences that are correlated over 20 scans: 5 % at six standard deviations.
  EXPECT_NEAR(std::sqrt(mean.x() / 1.5), sigma_m, 0.05 * sigma_m);
  EXPECT_NEAR(std::sqrt(mean.y() / 1.5), sigma_m, 0.05 * sigma_m);
  EXPECT_NEAR(std::sqrt(mean.z() / 1.5), sigma_rad, 0.05 * sigma_rad);
}

TEST(StepChanges, TellIndependentErrorsOfTheTilt) {
  const double sigma_rad = 0.006;
  const Stream stream(4, "slam.localize.init");
  StepChanges changes;
  double mean_square = 0.0;
  constexpr std::uint32_t scans = 20000;
  for (std::uint32_t i = 0; i < scans; ++i) {
    const Eigen::Vector3d tilt(sigma_rad * stream.gauss(0, i, 0), sigma_rad * stream.gauss(0, i, 1), 0.0);
    changes.add(Pose{exp_so3(tilt), Eigen::Vector3d::Zero()});
    mean_square += changes.tilt_sigma() * changes.tilt_sigma() / scans;
  }
  EXPECT_NEAR(std::sqrt(mean_square / 1.5), sigma_rad, 0.05 * sigma_rad);
}

TEST(StepChanges, AWayThatIsNotKnownIsNoChange) {
  StepChanges changes;
  const Pose step = Pose::from_xyz_yaw({0.06, 0.0, 0.0}, 0.0);
  Pose X_MR;
  for (int i = 0; i < 40; ++i) {
    if (i == 20) {
      changes.interrupt();
      X_MR.t.x() += 5.0;
    }
    changes.add(X_MR);
    X_MR = X_MR * step;
  }
  EXPECT_LT(changes.covariance().norm(), 1e-20);
}

}  // namespace
}  // namespace plumbline::slam
