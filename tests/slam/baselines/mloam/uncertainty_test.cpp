// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/mloam/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "bim/random/stream.h"

namespace plumbline::slam::mloam {
namespace {

constexpr int samples = 100'000;

/// A covariance of correlated increments with about these standard deviations.
Matrix6d correlated(double sigma_m, double sigma_rad, std::uint32_t seed) {
  const Stream stream(seed, "bim.generate");
  Matrix6d mix = Matrix6d::Identity();
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < row; ++column)
      mix(row, column) =
          0.6 * (stream.uniform(0, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)) - 0.5);
  Vector6d sigma;
  sigma << sigma_m, 0.5 * sigma_m, sigma_m, sigma_rad, sigma_rad, 0.5 * sigma_rad;
  const Matrix6d L = sigma.asDiagonal() * mix;
  return L * L.transpose();
}

/// The k-th increment of a distribution.
Vector6d draw(const Matrix6d& L, const Stream& stream, int k) {
  Vector6d unit;
  for (std::uint32_t i = 0; i < 6; ++i) unit[i] = stream.gauss(static_cast<std::uint64_t>(k), i);
  return L * unit;
}

Pose some_pose(double x, double yaw) {
  Pose X = Pose::from_xyz_yaw({x, -0.4, 0.3}, yaw);
  X.q = X.q * exp_so3({0.2, -0.5, 0.1});
  return X;
}

TEST(PointCovariance, IsThatOfAHundredThousandPoints) {
  const Pose X_AB = some_pose(1.5, 0.7);
  const Matrix6d S = correlated(0.05, 0.02, 8);
  const Eigen::Matrix3d S_p = Eigen::Vector3d(0.0025, 0.001, 0.004).asDiagonal();
  const Eigen::Vector3d p_B(4.0, -2.0, 1.0);
  const Matrix6d L = S.llt().matrixL();
  const Stream poses(9, "bim.generate"), points(10, "bim.generate");
  const Eigen::Vector3d sigma = S_p.diagonal().cwiseSqrt();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = 0; k < samples; ++k) {
    Eigen::Vector3d noise;
    for (std::uint32_t i = 0; i < 3; ++i) noise[i] = sigma[i] * points.gauss(static_cast<std::uint64_t>(k), i);
    const Eigen::Vector3d off = exp_se3(draw(L, poses, k)) * (X_AB * (p_B + noise)) - X_AB * p_B;
    sum += off * off.transpose();
  }
  const Eigen::Matrix3d measured = sum / samples;
  EXPECT_LT((point_covariance(X_AB, S, p_B, S_p) - measured).norm(), 0.02 * measured.norm());
}

// So with one LiDAR every residual weighs the same.
TEST(PointCovariance, OfAKnownMountHasTheSameTraceEverywhere) {
  const Eigen::Matrix3d S_p = 0.0025 * Eigen::Matrix3d::Identity();
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d p(0.4 * k, 3.0 - 0.2 * k, 0.1 * k);
    EXPECT_NEAR(point_covariance(some_pose(0.3, 0.1 * k), Matrix6d::Zero(), p, S_p).trace(), 0.0075, 1e-12);
  }
}

}  // namespace
}  // namespace plumbline::slam::mloam
