// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/reference_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumbline::scenarios::score {
namespace {

using Poses = std::vector<slam::StampedPose>;
constexpr slam::Nanoseconds tenth = 100'000'000;

/// A climbing bend of 60 poses, 0.5 m apart.
Poses bend() {
  Poses poses;
  Pose X = Pose::from_xyz_yaw({10.0, -20.0, 3.0}, 2.0);
  Vector6d step;
  step << 0.5, 0.0, 0.02, 0.0, 0.01, 0.03;
  for (int i = 0; i < 60; ++i) {
    poses.push_back({(i + 10) * tenth, X});
    X = X * exp_se3(step);
  }
  return poses;
}

/// Along x, 0.5 m a pose, level.
Poses line(int count) {
  Poses poses;
  for (int i = 0; i < count; ++i) poses.push_back({i * tenth, Pose::from_xyz_yaw({0.5 * i, 0.0, 0.0}, 0.0)});
  return poses;
}

Poses moved(const Poses& poses_W, const Pose& X_FW) {
  Poses poses;
  for (const slam::StampedPose& pose : poses_W) poses.push_back({pose.stamp, X_FW * pose.X_FR});
  return poses;
}

Pose far_away() {
  Vector6d xi;
  xi << 100.0, -30.0, 7.0, 0.4, -0.9, 2.0;
  return exp_se3(xi);
}

TEST(ReferenceScore, TheReferenceInAnyFrameScoresZero) {
  const Poses reference = bend();
  for (const Pose& X_FW : {Pose(), far_away()}) {
    const auto score = score_by_reference(reference, moved(reference, X_FW));
    ASSERT_TRUE(score);
    EXPECT_EQ(score->matched, reference.size());
    // Rounding of coordinates of 100 m; angles come from the small end of an arc cosine or sine.
    EXPECT_LT(score->ate_aligned_rmse_m, 1e-11);
    EXPECT_LT(score->steps->max_m, 1e-11);
    EXPECT_LT(score->steps->rotation_max_deg, 1e-5);
    EXPECT_LT(*score->rpe_1m_rmse_m, 1e-11);
    EXPECT_LT(*score->rpe_1m_rotation_deg, 1e-5);
  }
}

TEST(ReferenceScore, OneStepThatIsTooLongIsTheLargestError) {
  const Poses reference = line(21);
  Poses poses = reference;
  for (std::size_t i = 11; i < poses.size(); ++i) poses[i].X_FR.t.x() += 0.3;
  const auto score = score_by_reference(reference, poses);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->steps->max_m, 0.3, 1e-12);
  EXPECT_NEAR(score->steps->median_m, 0.0, 1e-12);
  // 11 poses 0.3 m behind 10 others: about their mean, 0.3 sqrt(11 * 10) / 21.
  EXPECT_NEAR(score->ate_aligned_rmse_m, 0.3 * std::sqrt(110.0) / 21.0, 1e-12);
  // Stretches of a metre start at 19 poses, and two of them go over the long step.
  EXPECT_NEAR(*score->rpe_1m_rmse_m, 0.3 * std::sqrt(2.0 / 19.0), 1e-12);
}

TEST(ReferenceScore, OneTurnTooMuchIsARotationError) {
  const Poses reference = line(9);
  Poses poses = reference;
  for (std::size_t i = 5; i < poses.size(); ++i) {
    const Pose turn = Pose::from_xyz_yaw(poses[5].X_FR.t, 0.1) * Pose::from_xyz_yaw(-poses[5].X_FR.t, 0.0);
    poses[i].X_FR = turn * poses[i].X_FR;
  }
  const auto score = score_by_reference(reference, poses);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->steps->rotation_max_deg, 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(score->steps->rotation_median_deg, 0.0, 1e-6);
  EXPECT_NEAR(score->steps->max_m, 0.0, 1e-12);
}

TEST(ReferenceScore, AHillCountsAsWay) {
  // Straight up: a metre of it is a metre, though no metre over ground.
  Poses up;
  for (int i = 0; i < 9; ++i) up.push_back({i * tenth, Pose::from_xyz_yaw({0.0, 0.0, 0.5 * i}, 0.0)});
  Poses poses = up;
  for (slam::StampedPose& pose : poses) pose.X_FR.t *= 1.1;
  EXPECT_NEAR(*score_by_reference(up, poses)->rpe_1m_rmse_m, 0.1, 1e-12);
}

TEST(ReferenceScore, TheEstimateIsInterpolatedWithinItsSpan) {
  const Poses estimate = line(21);  // 0 to 2 s
  Poses reference;
  for (int i = -5; i < 30; ++i) {
    const slam::Nanoseconds t = i * tenth + tenth / 4;
    reference.push_back({t, Pose::from_xyz_yaw({5.0 * slam::seconds(t), 1.0, 2.0}, 0.0)});
  }
  const auto score = score_by_reference(reference, estimate);
  ASSERT_TRUE(score);
  EXPECT_EQ(score->matched, 20U);
  EXPECT_LT(score->ate_aligned_rmse_m, 1e-12);
  EXPECT_LT(score->steps->max_m, 1e-12);
}

TEST(ReferenceScore, NothingIsInterpolatedWhereTheEstimateIsSilent) {
  Poses reference = line(41);
  Poses estimate;
  for (std::size_t i = 0; i < reference.size(); ++i)
    if (i <= 10 || i >= 30) estimate.push_back(reference[i]);
  const std::vector<PosePair> pairs = match_reference(reference, estimate);
  EXPECT_EQ(pairs.size(), 22U);
  for (const PosePair& pair : pairs) EXPECT_TRUE(pair.scan <= 10 || pair.scan >= 30) << pair.scan;
  // The step over the silence is none.
  EXPECT_LT(score_by_reference(reference, estimate)->steps->max_m, 1e-12);
}

TEST(ReferenceScore, OtherTimesMatchNothing) {
  const Poses reference = line(21);
  Poses later = reference;
  for (slam::StampedPose& pose : later) pose.stamp += 1000 * tenth;
  EXPECT_FALSE(score_by_reference(reference, later));
  for (slam::StampedPose& pose : later) pose.stamp -= (1000 - 19) * tenth;  // two in common
  EXPECT_FALSE(score_by_reference(reference, later));
  EXPECT_FALSE(score_by_reference(reference, {}));
  EXPECT_FALSE(score_by_reference({}, reference));
}

TEST(ReferenceScore, StampsThatDifferByTheirLastDigitsMatch) {
  const Poses reference = line(21);
  Poses poses = reference;
  for (slam::StampedPose& pose : poses) pose.stamp += 2000;  // 2 us; the first is beyond the end
  EXPECT_EQ(match_reference(reference, poses).size(), 21U);
}

TEST(PathScore, SaysLengthStraightnessAndHeight) {
  Poses corner = line(3);
  corner.push_back({3 * tenth, Pose::from_xyz_yaw({1.0, 1.0, -0.25}, 0.0)});
  corner.push_back({4 * tenth, Pose::from_xyz_yaw({1.0, 1.0, 0.5}, 0.0)});
  const PathScore score = score_path(corner);
  EXPECT_EQ(score.poses, 5U);
  EXPECT_DOUBLE_EQ(score.duration_s, 0.4);
  const double length = 1.0 + std::hypot(1.0, 0.25) + 0.75;
  EXPECT_DOUBLE_EQ(score.length_m, length);
  EXPECT_DOUBLE_EQ(*score.straightness, 1.5 / length);
  EXPECT_DOUBLE_EQ(score.vertical_m, 0.75);
  EXPECT_DOUBLE_EQ(*score_path(line(9)).straightness, 1.0);
  EXPECT_FALSE(score_path(Poses(4)).straightness);
  EXPECT_EQ(score_path({}).poses, 0U);
}

}  // namespace
}  // namespace plumbline::scenarios::score
