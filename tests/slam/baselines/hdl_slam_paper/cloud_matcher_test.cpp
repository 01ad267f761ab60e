// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"

namespace plumbline::slam::hdl {
namespace {

/// Points on the floor and two walls of a corner with a step in it, so that all directions are held.
std::vector<Eigen::Vector3d> corner(std::uint64_t seed) {
  const Stream stream(seed, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const double u = 4.0 * stream.uniform(0, i, 0), v = 2.5 * stream.uniform(0, i, 1);
    switch (i % 4) {
      case 0:
        points.emplace_back(u, 1.6 * v, 0.0);
        break;
      case 1:
        points.emplace_back(u, 0.0, v);
        break;
      case 2:
        points.emplace_back(0.0, u, v);
        break;
      default:
        points.emplace_back(1.5 + 0.1 * u, 1.5, 0.4 * v);
    }
  }
  return points;
}

std::vector<Eigen::Vector3d> moved(const Pose& X, std::vector<Eigen::Vector3d> points) {
  for (Eigen::Vector3d& p : points) p = X * p;
  return points;
}

TEST(NdtConstants, AgreeWithPublishedOnes) {
  EXPECT_NEAR(ndt_constants(0.5, 0.55).d1, -0.70445, 1e-5);
  EXPECT_NEAR(ndt_constants(0.5, 0.55).d2, 0.75636, 1e-5);
  EXPECT_NEAR(ndt_constants(1.0, 0.55).d1, -2.21723, 1e-5);
  EXPECT_NEAR(ndt_constants(1.0, 0.55).d2, 0.43312, 1e-5);
  EXPECT_NEAR(ndt_constants(2.0, 0.55).d1, -4.19652, 1e-5);
  EXPECT_NEAR(ndt_constants(2.0, 0.55).d2, 0.24848, 1e-5);
}

class Matchers : public testing::TestWithParam<bool> {
 protected:
  Matchers() : matcher_(GetParam() ? make_gicp({.epsilon_m = 1e-4, .rotation_epsilon = 1e-6}) : make_ndt({})) {}
  const std::unique_ptr<CloudMatcher> matcher_;
};

TEST_P(Matchers, FindsAKnownMotion) {
  matcher_->set_target(corner(1));
  const Pose X_TS = Pose::from_xyz_yaw({0.15, -0.1, 0.05}, 0.05);
  const CloudMatch match = matcher_->match(moved(X_TS.inverse(), corner(2)), Pose());
  EXPECT_TRUE(match.converged);
  const Pose off = X_TS.inverse() * match.X_TS;
  // Cells of half a metre, from other samples of the same surfaces.
  EXPECT_LT(off.t.norm(), 0.015);
  EXPECT_LT(log_so3(off.q).norm(), 0.01);
}

// Most of a cell away, the first steps are short. No surface lies on the border of two cells.
TEST(Ndt, ConvergesFromAFarGuess) {
  const std::unique_ptr<CloudMatcher> ndt = make_ndt({.cell_m = 1.0});
  const Pose aside = Pose::from_xyz_yaw({0.31, 0.27, 0.35}, 0.0);
  ndt->set_target(moved(aside, corner(1)));
  for (const double x : {-0.6, -0.4, 0.4, 0.6}) {
    const Pose X_TS = Pose::from_xyz_yaw({x, 0.2, 0.0}, 0.05);
    const Pose off = X_TS.inverse() * ndt->match(moved(X_TS.inverse() * aside, corner(2)), Pose()).X_TS;
    EXPECT_LT(off.t.norm(), 0.03) << x;
    EXPECT_LT(log_so3(off.q).norm(), 0.01) << x;
  }
}

TEST_P(Matchers, WithoutPointsTheGuessStands) {
  const Pose guess = Pose::from_xyz_yaw({1.0, 2.0, 3.0}, 0.5);
  EXPECT_FALSE(matcher_->match(corner(1), guess).converged);
  matcher_->set_target(corner(1));
  for (const auto& points : {std::vector<Eigen::Vector3d>{}, moved(Pose::from_xyz_yaw({50, 50, 0}, 0), corner(2))}) {
    const CloudMatch match = matcher_->match(points, guess);
    EXPECT_FALSE(match.converged);
    EXPECT_EQ(match.X_TS.t, guess.t);
  }
}

// One thread and fixed sums: bit for bit.
TEST_P(Matchers, GivesTheSameBitsAgain) {
  matcher_->set_target(corner(1));
  const Pose first = matcher_->match(corner(3), Pose()).X_TS;
  matcher_->set_target(corner(1));
  const Pose again = matcher_->match(corner(3), Pose()).X_TS;
  EXPECT_EQ(first.t, again.t);
  EXPECT_EQ(first.q.coeffs(), again.q.coeffs());
}

INSTANTIATE_TEST_SUITE_P(Registration, Matchers, testing::Bool(),
                         [](const auto& gicp) { return std::string(gicp.param ? "gicp" : "ndt"); });

}  // namespace
}  // namespace plumbline::slam::hdl
