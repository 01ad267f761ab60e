// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/pcl_registration/pcl_matcher.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "slam/scan/motion.h"
#include "slam/scan/voxel.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct Case {
  std::string name;
  std::function<std::unique_ptr<PclMatcher>()> make;
  double from_afar_m, from_afar_rad;  ///< bounds of the error from a guess 0.4 m and 7 degrees off
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

/// What a robot sees from X_WR, in R, in a room with two columns.
std::vector<Eigen::Vector3d> seen_from(const Pose& X_WR, double voxel_m) {
  synthetic::House house = synthetic::one_room(8.0, 5.0);
  house.boxes.push_back({{2.0, 3.5, 0.0}, {2.4, 3.9, 2.8}});
  house.boxes.push_back({{5.5, 1.0, 0.0}, {6.0, 1.8, 1.2}});
  synthetic::WalkConfig walk;
  walk.vibration = 0.0;
  MotionBuffer motion;
  motion.add({0, Pose{}});
  const DeskewedScan scan = deskew(synthetic::standing_scan(house, X_WR, walk), motion, synthetic::calibration());
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] > 0.0) points.push_back(scan.point_R[i]);
  return voxel_downsample(points, voxel_m);
}

const Pose X_WT = Pose::from_xyz_yaw({3.0, 2.2, 0.46}, 0.2);
const Pose X_TS = Pose::from_xyz_yaw({0.35, -0.2, 0.0}, 0.12);

class PclMatcherTest : public testing::TestWithParam<Case> {};

TEST_P(PclMatcherTest, RecoversAMotionFromAWrongGuess) {
  const auto matcher = GetParam().make();
  matcher->set_target(seen_from(X_WT, 0.1));
  const std::vector<Eigen::Vector3d> source = seen_from(X_WT * X_TS, 0.2);
  const auto expect = [&](const Pose& guess, double bound_m, double bound_rad) {
    const PclMatch match = matcher->match(source, guess);
    ASSERT_TRUE(match.converged);
    const Pose error = X_TS.inverse() * match.X_TS;
    EXPECT_LT(error.t.norm(), bound_m);
    EXPECT_LT(log_so3(error.q).norm(), bound_rad);
    EXPECT_NEAR(match.X_TS.q.norm(), 1.0, 1e-12);
    EXPECT_GT(match.matched, 0.9);
  };
  // 12 mm of noise over some thousand points, and what thinning to voxels moves.
  expect(X_TS, 0.03, 0.01);
  expect(Pose{}, GetParam().from_afar_m, GetParam().from_afar_rad);
}

TEST_P(PclMatcherTest, GivesTheSameBytesAtAnyNumberOfThreads) {
  const std::vector<Eigen::Vector3d> target = seen_from(X_WT, 0.1), source = seen_from(X_WT * X_TS, 0.2);
  const auto match = [&](const char* threads) {
    setenv("OMP_NUM_THREADS", threads, 1);
    const auto matcher = GetParam().make();
    matcher->set_target(target);
    return matcher->match(source, Pose{});
  };
  const PclMatch a = match("1"), b = match("2"), c = match("1");
  unsetenv("OMP_NUM_THREADS");
  for (const PclMatch& other : {b, c}) {
    EXPECT_EQ(a.X_TS.t, other.X_TS.t);
    EXPECT_EQ(a.X_TS.q.coeffs(), other.X_TS.q.coeffs());
    EXPECT_EQ(a.matched, other.matched);
  }
}

TEST_P(PclMatcherTest, ForgetsTheTargetBefore) {
  const auto fresh = GetParam().make(), used = GetParam().make();
  const std::vector<Eigen::Vector3d> source = seen_from(X_WT * X_TS, 0.2);
  used->set_target(seen_from(Pose::from_xyz_yaw({6.5, 3.5, 0.46}, 2.0), 0.1));
  (void)used->match(source, Pose{});
  for (PclMatcher* matcher : {fresh.get(), used.get()}) matcher->set_target(seen_from(X_WT, 0.1));
  EXPECT_EQ(fresh->match(source, Pose{}).X_TS.t, used->match(source, Pose{}).X_TS.t);
}

TEST_P(PclMatcherTest, FindsNothingWithFewPoints) {
  const std::vector<Eigen::Vector3d> points = seen_from(X_WT, 0.2);
  const std::vector<Eigen::Vector3d> few(points.begin(), points.begin() + PclMatcher::least_points - 1);
  const auto found = [&](const std::vector<Eigen::Vector3d>& target, const std::vector<Eigen::Vector3d>& source) {
    const auto matcher = GetParam().make();
    matcher->set_target(target);
    const PclMatch match = matcher->match(source, X_TS);
    if (!match.converged) {
      EXPECT_EQ(match.X_TS.t, X_TS.t) << "the guess stands";
      EXPECT_EQ(match.matched, 0.0);
    }
    return match.converged;
  };
  EXPECT_FALSE(found(points, {}));
  EXPECT_FALSE(found(points, few));
  EXPECT_FALSE(found({}, points));
  EXPECT_FALSE(found(few, points));
  EXPECT_TRUE(found(points, points));
}

INSTANTIATE_TEST_SUITE_P(Pcl, PclMatcherTest,
                         testing::Values(Case{"gicp", [] { return make_pcl_gicp({}, 0.2); }, 0.03, 0.01},
                                         Case{"ndt", [] { return make_pcl_ndt({}, 0.2); }, 0.1, 0.05}),
                         [](const auto& info) { return info.param.name; });

// With PCL's own epsilon the iteration ends after one step of 0.1 m.
TEST(PclNdt, StopsTooEarlyAtPclsOwnEpsilon) {
  PclNdtConfig own;
  own.epsilon_m2 = 0.1;
  const auto error = [](const PclNdtConfig& config) {
    const auto matcher = make_pcl_ndt(config, 0.2);
    matcher->set_target(seen_from(X_WT, 0.1));
    return (X_TS.inverse() * matcher->match(seen_from(X_WT * X_TS, 0.2), Pose{}).X_TS).t.norm();
  };
  EXPECT_GT(error(own), 0.2);
  EXPECT_LT(error({}), 0.1);
}

}  // namespace
}  // namespace plumbline::slam
