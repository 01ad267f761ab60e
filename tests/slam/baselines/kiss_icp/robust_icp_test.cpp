// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/robust_icp.h"

#include <gtest/gtest.h>

#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam::kiss {
namespace {

/// Points on a floor and two walls that meet at `corner`, spread at random.
std::vector<Eigen::Vector3d> corner_points(const Eigen::Vector3d& corner, std::uint64_t count) {
  const Stream random(5, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3d p(5.0 * random.uniform(i, 0), 5.0 * random.uniform(i, 1), 5.0 * random.uniform(i, 2));
    p[static_cast<Eigen::Index>(i % 3)] = 0.0;
    points.push_back(corner + p);
  }
  return points;
}

VoxelHashMap map_of(const std::vector<Eigen::Vector3d>& points_M) {
  VoxelHashMap map(1.0, 100);
  for (const Eigen::Vector3d& p : points_M) map.add(p);
  return map;
}

std::vector<Eigen::Vector3d> seen_from(const Pose& X_ML, const std::vector<Eigen::Vector3d>& points_M,
                                       const VoxelHashMap& map) {
  std::vector<Eigen::Vector3d> points_L;
  for (const Eigen::Vector3d& p_M : points_M)
    if (map.nearest(p_M, 1e-12) != nullptr) points_L.push_back(X_ML.inverse() * p_M);
  return points_L;
}

TEST(GemanMcClure, WeighsAQuarterWhereTheSquaredResidualIsTheScale) {
  EXPECT_EQ(geman_mcclure(0.0, 0.3), 1.0);
  EXPECT_DOUBLE_EQ(geman_mcclure(0.3, 0.3), 0.25);
  EXPECT_DOUBLE_EQ(geman_mcclure(2.0, 2.0), 0.25);
  EXPECT_LT(geman_mcclure(100.0, 0.3), 1e-4);
}

// The residuals vanish at the true pose, which ICP then reaches to the last digits, wherever M has its origin.
TEST(RegisterPoints, FindsThePoseOfTheSamePoints) {
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(4000.0, -3000.0, 100.0)}) {
    const std::vector<Eigen::Vector3d> points_M = corner_points(corner, 1500);
    const VoxelHashMap map = map_of(points_M);
    const Pose truth = Pose::from_xyz_yaw(corner + Eigen::Vector3d(2.0, 2.5, 1.0), 0.7);
    Pose guess = truth;
    guess.t += Eigen::Vector3d(0.03, -0.02, 0.02);
    guess.q = (guess.q * exp_so3({0.005, -0.005, 0.01})).normalized();
    const std::vector<Eigen::Vector3d> points_L = seen_from(truth, points_M, map);
    ASSERT_GT(points_L.size(), 500U);
    const RobustIcpResult result = register_points(points_L, map, guess, {.kernel_m = 0.1, .convergence = 1e-9});
    EXPECT_LT((result.X_ML.t - truth.t).norm(), 1e-8);
    EXPECT_LT(log_so3(result.X_ML.q.conjugate() * truth.q).norm(), 1e-9);
    EXPECT_EQ(result.matched, points_L.size());
    EXPECT_LT(result.matched_rms, 1e-8);
    EXPECT_LT(result.iterations, 30);
  }
}

TEST(RegisterPoints, OutliersWeighLittle) {
  const std::vector<Eigen::Vector3d> points_M = corner_points({0.0, 0.0, 0.0}, 1500);
  const VoxelHashMap map = map_of(points_M);
  const Pose truth = Pose::from_xyz_yaw({2.0, 2.5, 1.0}, 0.7);
  std::vector<Eigen::Vector3d> points_L = seen_from(truth, points_M, map);
  const std::size_t third = points_L.size() / 3;
  for (std::size_t i = 0; i < third; ++i)
    points_L.push_back(truth.inverse() * (points_M[i] + Eigen::Vector3d(0.6, 0.6, 0.6)));
  const auto error = [&](double kernel_m) {
    const RobustIcpResult result =
        register_points(points_L, map, truth, {.max_distance_m = 2.0, .kernel_m = kernel_m, .convergence = 1e-7});
    return (result.X_ML.t - truth.t).norm();
  };
  EXPECT_LT(error(1e-3), 2e-3);
  EXPECT_GT(error(10.0), 10.0 * error(1e-3)) << "wide kernels make it least squares";
}

TEST(RegisterPoints, GivesTheGuessWhereThereIsNothingToRegister) {
  const Pose guess = Pose::from_xyz_yaw({1.0, 2.0, 3.0}, 0.4);
  const std::vector<Eigen::Vector3d> points = corner_points({0.0, 0.0, 0.0}, 90);
  const VoxelHashMap empty(1.0, 20), map = map_of(points);
  const auto is_guess = [&](const RobustIcpResult& result) {
    return result.X_ML.t == guess.t && result.X_ML.q.coeffs() == guess.q.coeffs() && result.matched == 0;
  };
  EXPECT_TRUE(is_guess(register_points(points, empty, guess, {})));
  EXPECT_TRUE(is_guess(register_points({}, map, guess, {})));
  const std::vector<Eigen::Vector3d> far(10, Eigen::Vector3d(500.0, 0.0, 0.0));
  EXPECT_TRUE(is_guess(register_points(far, map, guess, {})));
}

// A line of points leaves the turn about itself free.
TEST(RegisterPoints, StaysFiniteWhereAMotionIsNotDetermined) {
  VoxelHashMap map(1.0, 20);
  std::vector<Eigen::Vector3d> line;
  for (int k = 0; k < 40; ++k) {
    line.emplace_back(0.5 * k, 0.0, 0.0);
    map.add({0.5 * k + 0.1, 0.05, -0.02});
  }
  for (const std::size_t count : {1U, 2U, 3U, 40U}) {
    const RobustIcpResult result = register_points(std::span(line).first(count), map, Pose{}, {});
    EXPECT_TRUE(result.X_ML.t.allFinite() && result.X_ML.q.coeffs().allFinite()) << count;
    EXPECT_NEAR(result.X_ML.q.norm(), 1.0, 1e-9);
    EXPECT_LT(result.X_ML.t.norm(), 1.0) << count;
  }
}

}  // namespace
}  // namespace plumbline::slam::kiss
