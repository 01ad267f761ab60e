// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/odometry_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

/// Along a circle, slightly rolling.
Odometry odometry_at(Nanoseconds stamp) {
  const double s = seconds(stamp);
  return {stamp, exp_se3((Vector6d() << 0.3 * s, -0.1 * s, 0.0, 1e-3 * s, 0.0, 0.2 * s).finished())};
}

/// What the summed covariance of many small errors should be, against draws of them.
TEST(OdometryMotion, TheCovarianceOfThePoseIsThatOfItsMotions) {
  std::vector<Odometry> records;
  for (int i = 0; i <= 30; ++i) records.push_back(odometry_at(Nanoseconds{100'000'000} * i));
  const Matrix6d covariance = (Vector6d() << 1e-6, 4e-6, 9e-6, 1e-6, 2e-6, 4e-6).finished().asDiagonal();
  OdometryMotion motion;
  ros::OdometryMessage last;
  for (const Odometry& record : records)
    last = motion.message(record, record.stamp > 0 ? std::optional(covariance) : std::nullopt);
  const Stream stream(5, "bim.generate");
  constexpr int draws = 4000;
  Matrix6d sum = Matrix6d::Zero();
  for (std::uint64_t k = 0; k < draws; ++k) {
    Pose X_OR = records.front().X_OR;
    for (std::size_t i = 1; i < records.size(); ++i) {
      Vector6d noise;
      for (int j = 0; j < 6; ++j)
        noise[j] = std::sqrt(covariance(j, j)) *
                   stream.gauss(k, static_cast<std::uint32_t>(6 * i) + static_cast<std::uint32_t>(j));
      X_OR = X_OR * (records[i - 1].X_OR.inverse() * records[i].X_OR) * exp_se3(noise);
    }
    Vector6d error;
    error << X_OR.t - records.back().X_OR.t, log_so3(X_OR.q * records.back().X_OR.q.conjugate());
    sum += error * error.transpose();
  }
  // A variance from 4,000 draws is known to 2.2 %; entries are compared on the scale of their variances.
  const Matrix6d drawn = sum / draws;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(drawn(i, j), last.pose_covariance(i, j),
                  0.1 * std::sqrt(last.pose_covariance(i, i) * last.pose_covariance(j, j)))
          << i << j;
  EXPECT_LT((last.twist - (Vector6d() << 0.3, -0.1, 0.0, 1e-3, 0.0, 0.2).finished()).norm(), 1e-9);
}

TEST(OdometryMotion, ATwistGivesBackTheMotionsCovariance) {
  OdometryMotion motion;
  const Matrix6d covariance = Matrix6d::Identity() * 1e-8;
  EXPECT_FALSE(increment_covariance(motion.message(odometry_at(0), {}), 10'000'000).has_value());
  const auto back = increment_covariance(motion.message(odometry_at(10'000'000), covariance), 10'000'000);
  ASSERT_TRUE(back.has_value());
  EXPECT_LE((*back - covariance).norm(), 1e-20);
  EXPECT_FALSE(increment_covariance(motion.message(odometry_at(20'000'000), {}), 10'000'000).has_value());
  ros::OdometryMessage odd;
  odd.twist_covariance = Matrix6d::Identity() * std::nan("");
  EXPECT_FALSE(increment_covariance(odd, 10'000'000).has_value());
}

}  // namespace
}  // namespace plumbline::slam
