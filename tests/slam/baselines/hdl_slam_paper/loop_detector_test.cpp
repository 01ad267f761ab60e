// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/loop_detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/loop/fitness.h"

namespace plumbline::slam::hdl {
namespace {

LoopKeyframe keyframe(double x, double walked_m, double z = 0.0) {
  return {Pose::from_xyz_yaw({x, 0.0, z}, 0.0), walked_m, nullptr};
}

TEST(LoopCandidates, AreNearAndLongAgo) {
  const LoopDetectorConfig config;
  using Indices = std::vector<std::size_t>;
  EXPECT_EQ(loop_candidates({keyframe(0, 0), keyframe(0.5, 4)}, -10, config), (Indices{0}));
  EXPECT_EQ(loop_candidates({keyframe(0, 0), keyframe(0.0, 2)}, -10, config), (Indices{}));  // walked 2 m only
  EXPECT_EQ(loop_candidates({keyframe(0, 0), keyframe(1.1, 4)}, -10, config), (Indices{}));  // too far
  EXPECT_EQ(loop_candidates({keyframe(0, 0), keyframe(0.5, 4)}, 3.5, config), (Indices{}));  // one was closed just now
  // As in the reference: other storeys are candidates.
  EXPECT_EQ(loop_candidates({keyframe(0, 0), keyframe(0.5, 9, 3.0)}, -10, config), (Indices{0}));
}

std::vector<Eigen::Vector3d> cube(double shift_m) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) {
      points.emplace_back(0.1 * i + shift_m, 0.1 * k, 0.0);
      points.emplace_back(0.1 * i + shift_m, 0.0, 0.1 * k);
      points.emplace_back(shift_m, 0.1 * i, 0.1 * k);
    }
  return points;
}

TEST(Loops, TheBestFitWinsAndMustFit) {
  const std::vector<Eigen::Vector3d> here = cube(0.0), moved = cube(0.1), elsewhere = {{0, 0, 5}, {1, 0, 6}, {0, 1, 7}};
  const auto matcher = make_gicp({.neighbours = 8, .epsilon_m = 1e-4});
  std::vector<LoopKeyframe> keyframes = {
      {Pose(), 0.0, &elsewhere}, {Pose(), 1.0, &moved}, {Pose::from_xyz_yaw({0.05, 0.0, 0.0}, 0.0), 9.0, &here}};
  const std::optional<HdlLoop> loop = detect_loop(keyframes, 0.0, {}, *matcher);
  ASSERT_TRUE(loop.has_value());
  EXPECT_EQ(loop->keyframe, 1U);
  EXPECT_NEAR(loop->X_FT.t.x(), 0.1, 0.02);
  // Half of its points lie 5 m away from everything.
  std::vector<Eigen::Vector3d> half = moved;
  for (const Eigen::Vector3d& p : moved) half.emplace_back(p.x() + 7.0, p.y(), p.z());
  keyframes[1].points_R = &half;
  EXPECT_FALSE(detect_loop(keyframes, 0.0, {}, *matcher).has_value());
}

// The table of the reference's weights: standard deviations of position and of the quaternion's vector part.
TEST(Weights, AgreeWithTheReference) {
  const FitnessConfig config{.sigma_min_rad = 0.1, .sigma_max_rad = 0.4};
  const auto check = [&](double fitness_m2, double sigma_m, double half_rad) {
    const Matrix6d information = fitness_information(fitness_m2, config);
    EXPECT_NEAR(1.0 / std::sqrt(information(0, 0)), sigma_m, 0.005);
    EXPECT_NEAR(0.5 / std::sqrt(information(5, 5)), half_rad, 0.0005);
  };
  check(0.001, 0.71, 0.057);
  check(0.005, 1.55, 0.078);
  check(0.02, 2.87, 0.122);
  check(0.05, 3.98, 0.162);
}

}  // namespace
}  // namespace plumbline::slam::hdl
