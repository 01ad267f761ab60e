// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/trajectory.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

Vector6d random_twist(const Stream& stream, std::uint64_t tick, double meters, double radians) {
  Vector6d xi;
  for (std::uint32_t k = 0; k < 6; ++k) xi[k] = (2.0 * stream.uniform(tick, k) - 1.0) * (k < 3 ? meters : radians);
  return xi;
}

/// A wandering walk: `count` scans, about 0.06 m apart.
Truth random_truth(std::uint64_t seed, std::size_t count) {
  const Stream stream(seed, "bim.generate");
  Truth truth;
  Pose X_WR = exp_se3(random_twist(stream, 0, 5.0, 1.0));
  for (std::size_t i = 0; i < count; ++i) {
    const auto stamp = static_cast<slam::Nanoseconds>(i + 1) * scan_ns;
    truth.poses_W.push_back({stamp, X_WR});
    truth.scans.push_back(stamp);
    Vector6d step = random_twist(stream, i + 1, 0.02, 0.1);
    step.x() += 0.06;
    X_WR = X_WR * exp_se3(step);
  }
  return truth;
}

std::vector<slam::StampedPose> moved(const Truth& truth, const Pose& X_FW) {
  std::vector<slam::StampedPose> poses;
  for (const slam::StampedPose& pose : truth.poses_W) poses.push_back({pose.stamp, X_FW * pose.X_FR});
  return poses;
}

TEST(Trajectory, TruthInAnyFrameScoresZero) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Truth truth = random_truth(seed, 200);
    const Pose X_FW = exp_se3(random_twist(Stream(seed, "bim.generate"), 9999, 20.0, 3.0));
    const auto poses = moved(truth, X_FW);
    const auto score = score_trajectory(truth, poses, poses);
    ASSERT_TRUE(score);
    // Rounding of coordinates of some 20 m: a few 1e-15 relative, over a rotation fitted to them.
    EXPECT_LT(score->ate_rmse_m, 1e-12);
    EXPECT_LT(score->ate_aligned_rmse_m, 1e-12);
    EXPECT_LT(*score->ate_final_rmse_m, 1e-12);
    EXPECT_LT(*score->rpe_1m_rmse_m, 1e-12);
    EXPECT_EQ(score->coverage, 1.0);
    const Pose residual = score->X_WF_final * X_FW;
    EXPECT_LT(log_se3(residual).norm(), 1e-11);
  }
}

TEST(Trajectory, AlignmentIsABestFit) {
  const Stream stream(3, "bim.generate");
  const Truth truth = random_truth(3, 150);
  auto poses = moved(truth, Pose());
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) poses[i].X_FR.t[k] += 0.1 * stream.gauss(i, k);
  const auto pairs = associate(truth, poses, {});
  const Pose X_WF = umeyama(pairs);
  const double best = position_rmse(pairs, X_WF);
  for (std::uint64_t trial = 0; trial < 500; ++trial)
    EXPECT_GE(position_rmse(pairs, X_WF * exp_se3(random_twist(stream, 1000 + trial, 0.02, 0.01))), best);
  EXPECT_LE(best, position_rmse(pairs, place_by_first(pairs)));
}

TEST(Trajectory, AlignmentIsARotationEvenOfAMirrorImage) {
  const Truth truth = random_truth(5, 60);
  auto poses = moved(truth, Pose());
  for (auto& pose : poses) pose.X_FR.t.x() = -pose.X_FR.t.x();
  const Pose X_WF = umeyama(associate(truth, poses, {}));
  EXPECT_NEAR(X_WF.rotation().determinant(), 1.0, 1e-12);
}

TEST(Trajectory, AlignmentOfAStraightLineAndOfOnePointIsFinite) {
  Truth truth;
  for (int i = 0; i < 40; ++i) {
    const auto stamp = static_cast<slam::Nanoseconds>(i) * scan_ns;
    truth.poses_W.push_back({stamp, Pose::from_xyz_yaw({0.1 * i, 0.0, 0.5}, 0.0)});
    truth.scans.push_back(stamp);
  }
  const auto poses = moved(truth, Pose::from_xyz_yaw({1.0, 2.0, 0.0}, 0.5));
  EXPECT_LT(position_rmse(associate(truth, poses, {}), umeyama(associate(truth, poses, {}))), 1e-12);
  truth.scans.resize(1);
  const auto one = associate(truth, poses, {});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_LT(position_rmse(one, umeyama(one)), 1e-12);
}

/// Noise of a millimetre would turn the map of a straight corridor upside down.
TEST(Trajectory, AttitudesFixWhatPositionsLeaveFree) {
  const Stream stream(11, "bim.generate");
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    const Pose X_FW = exp_se3(random_twist(stream, 7000 + trial, 20.0, 3.0));
    const double step_m = trial % 2 == 0 ? 0.1 : 0.0;  // a corridor, or a robot that stands
    const Pose start = exp_se3(random_twist(stream, 8000 + trial, 5.0, 3.0));
    Truth truth;
    for (std::uint64_t i = 0; i < 200; ++i) {
      const auto stamp = static_cast<slam::Nanoseconds>(i) * scan_ns;
      const Pose sway = exp_se3(random_twist(stream, 1000 * (trial + 10) + i, 0.02, 0.02));
      truth.poses_W.push_back(
          {stamp, start * Pose::from_xyz_yaw({step_m * static_cast<double>(i), 0.0, 0.0}, 0.0) * sway});
      truth.scans.push_back(stamp);
    }
    auto poses = moved(truth, X_FW);
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (std::uint32_t k = 0; k < 3; ++k) poses[i].X_FR.t[k] += 0.01 * stream.gauss(500 * trial + i, k);
    const auto pairs = associate(truth, poses, {});
    // 1 cm of noise in 200 positions along 20 m turns their line by far less than this; attitudes have none.
    EXPECT_LT(log_so3((place_map(pairs) * X_FW).q).norm(), 0.01) << trial;
    EXPECT_GE(position_rmse(pairs, place_map(pairs)), position_rmse(pairs, umeyama(pairs)));
  }
  const Truth wide = random_truth(4, 400);
  const auto pairs = associate(wide, moved(wide, exp_se3(random_twist(stream, 1, 20.0, 3.0))), {});
  EXPECT_TRUE(place_map(pairs).rotation() == umeyama(pairs).rotation()) << "its positions leave nothing free";
}

TEST(Trajectory, HandComputed) {
  Truth truth;
  std::vector<slam::StampedPose> poses;
  for (int i = 0; i <= 20; ++i) {
    const auto stamp = static_cast<slam::Nanoseconds>(i) * scan_ns;
    truth.scans.push_back(stamp);
    truth.poses_W.push_back({stamp, Pose::from_xyz_yaw({0.1 * i, 0.0, 0.0}, 0.0)});
    poses.push_back({stamp, Pose::from_xyz_yaw({0.11 * i, 0.0, 0.0}, 0.0)});  // 10 % too long
  }
  const auto score = score_trajectory(truth, poses, {});
  ASSERT_TRUE(score);
  // Placed by the first pose the error is 0.01 i, mean of i^2 over 0..20 is 2870 / 21.
  EXPECT_NEAR(score->ate_rmse_m, 0.01 * std::sqrt(2870.0 / 21.0), 1e-12);
  // Aligned, the mean is taken off: variance of i is (21^2 - 1) / 12.
  EXPECT_NEAR(score->ate_aligned_rmse_m, 0.01 * std::sqrt(440.0 / 12.0), 1e-12);
  EXPECT_NEAR(*score->rpe_1m_rmse_m, 0.1, 0.0101);  // 10 % of a metre, plus at most one step
  EXPECT_FALSE(score->ate_final_rmse_m);
  // Three poses of many scans fit anything.
  const std::vector<slam::StampedPose> few(poses.begin(), poses.begin() + 3);
  EXPECT_FALSE(score_trajectory(truth, poses, few)->ate_final_rmse_m);
  EXPECT_TRUE(score_trajectory(truth, poses, poses)->ate_final_rmse_m);
  EXPECT_NEAR(truth.walked().back(), 2.0, 1e-12);
}

TEST(Trajectory, DriftOverTenMetres) {
  Truth truth;
  std::vector<slam::StampedPose> poses;
  const double turn_per_m = 0.3 * std::numbers::pi / 180.0;
  for (int i = 0; i <= 1500; ++i) {
    const auto stamp = static_cast<slam::Nanoseconds>(i) * scan_ns;
    truth.scans.push_back(stamp);
    truth.poses_W.push_back({stamp, Pose::from_xyz_yaw({0.01 * i, 0.0, 0.0}, 0.0)});
    // A straight way taken for an arc.
    const double a = turn_per_m * 0.01 * i;
    poses.push_back({stamp, Pose::from_xyz_yaw({std::sin(a) / turn_per_m, (1.0 - std::cos(a)) / turn_per_m, 0.0}, a)});
  }
  const auto score = score_trajectory(truth, poses, {});
  ASSERT_TRUE(score && score->drift_10m_percent && score->drift_10m_deg_per_m);
  const double a = 10.0 * turn_per_m;
  const double off = std::hypot(10.0 - std::sin(a) / turn_per_m, (1.0 - std::cos(a)) / turn_per_m);
  EXPECT_NEAR(*score->drift_10m_deg_per_m, 0.3, 0.3 * 0.0011);  // plus at most one step of a cm
  EXPECT_NEAR(*score->drift_10m_percent, 10.0 * off, 10.0 * off * 0.0025);
  EXPECT_FALSE(
      score_trajectory({.poses_W = truth.poses_W, .scans = {truth.scans.begin(), truth.scans.begin() + 900}}, poses, {})
          ->drift_10m_percent);  // 9 m
}

TEST(Trajectory, ErrorsOverADistanceAreOfNoMuchLongerOne) {
  // Ten metres from pose to pose: an error over them is none over a metre.
  const Truth sparse = straight_walk(20, Eigen::Vector3d::Zero(), 10.0);
  auto poses = moved(sparse, Pose());
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].X_FR.t.x() *= 1.1;
  const auto score = score_trajectory(sparse, poses, {});
  ASSERT_TRUE(score);
  EXPECT_FALSE(score->rpe_1m_rmse_m);
  EXPECT_NEAR(score->drift_10m_percent.value(), 10.0, 1e-9);
  // One gap takes nothing from the others.
  Truth gap = straight_walk(101, Eigen::Vector3d::Zero(), 0.5);
  gap.scans.erase(gap.scans.begin() + 40, gap.scans.begin() + 60);
  gap.poses_W.erase(gap.poses_W.begin() + 40, gap.poses_W.begin() + 60);
  poses = moved(gap, Pose());
  for (slam::StampedPose& pose : poses) pose.X_FR.t.x() *= 1.1;
  EXPECT_NEAR(score_trajectory(gap, poses, {})->rpe_1m_rmse_m.value(), 0.1, 1e-9);
}

TEST(Trajectory, AWrongTrajectoryScoresBadly) {
  const Truth truth = random_truth(11, 400);
  auto poses = moved(truth, Pose());
  for (std::size_t i = 0; i < poses.size(); ++i)  // a drift of heading of 60 degrees over the walk
    poses[i].X_FR = Pose::from_xyz_yaw(Eigen::Vector3d::Zero(), 1e-3 * std::numbers::pi * static_cast<double>(i)) *
                    truth.poses_W.front().X_FR.inverse() * poses[i].X_FR;
  const auto score = score_trajectory(truth, poses, poses);
  EXPECT_GT(score->ate_aligned_rmse_m, 0.5);
}

TEST(Trajectory, AssociatesWithinTenMillisecondsOnly) {
  const Truth truth = random_truth(2, 100);
  auto poses = moved(truth, Pose());
  for (auto& pose : poses) pose.stamp += 9'000'000;
  EXPECT_EQ(associate(truth, poses, {}).size(), 100U);
  for (auto& pose : poses) pose.stamp += 2'000'000;
  EXPECT_TRUE(associate(truth, poses, {}).empty());
  poses = moved(truth, Pose());
  poses.erase(poses.begin() + 10, poses.begin() + 20);
  EXPECT_NEAR(score_trajectory(truth, poses, {})->coverage, 0.9, 1e-12);
  EXPECT_FALSE(score_trajectory(truth, {}, {}));
  EXPECT_THROW(static_cast<void>(umeyama({})), InternalError);
}

TEST(Trajectory, TruthIsInterpolatedBetweenItsPoses) {
  Truth truth;
  truth.poses_W = {{0, Pose::from_xyz_yaw({0, 0, 0}, 0.0)}, {10, Pose::from_xyz_yaw({1, 0, 0}, 1.0)}};
  EXPECT_NEAR(truth.at(5).t.x(), 0.5, 1e-15);
  EXPECT_NEAR(truth.at(5).yaw(), 0.5, 1e-12);
  EXPECT_EQ(truth.at(-3).t.x(), 0.0);
  EXPECT_EQ(truth.at(99).t.x(), 1.0);
}

TEST(Trajectory, ErrorsOverTheLastMetre) {
  const Truth truth = straight_walk(21, {0.0, 0.0, 0.0}, 0.1);
  std::vector<PosePair> pairs = associate(truth, truth.poses_W, {});
  pairs[15].X_FR.t.y() += 0.05;  // one pose that is off: seen where a metre ends there, and where one begins there
  const auto errors = errors_over(pairs, truth.walked(), 0.95);
  ASSERT_EQ(errors.size(), 21U);
  for (std::size_t i = 0; i < 21; ++i) EXPECT_EQ(errors[i].has_value(), i >= 10) << i;
  EXPECT_NEAR(*errors[14], 0.0, 1e-12);
  EXPECT_NEAR(*errors[15], 0.05, 1e-12);
  EXPECT_NEAR(*errors[16], 0.0, 1e-12);
  EXPECT_TRUE(errors_over({}, {}, 1.0).empty());
}

}  // namespace
}  // namespace plumbline::scenarios::score
