// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/optimize.h"

#include <gtest/gtest.h>

#include "slam/graph/factors.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

struct Problem {
  Graph graph;
  std::vector<Pose> truth;
  std::vector<Plane> planes;
};

/// A walk round a 8 x 6 m hall about the map's origin whose walls and floor are seen from every keyframe; odometry is
/// `scale` times the true step, with noise.
Problem make_hall(std::uint64_t seed, double scale, double noise) {
  RandomValues random(seed, 0);
  Problem p;
  p.planes = {{{1, 0, 0}, 4.0}, {{-1, 0, 0}, 4.0}, {{0, 1, 0}, 3.0}, {{0, -1, 0}, 3.0}, {{0, 0, 1}, 0.6}};
  constexpr int keyframes = 40;
  for (int k = 0; k < keyframes; ++k) {
    const double a = 2.0 * std::numbers::pi * k / keyframes;
    p.truth.push_back(Pose::from_xyz_yaw({3.0 * std::cos(a), 2.0 * std::sin(a), 0.0}, a + 0.5 * std::numbers::pi));
  }
  Pose X_MR = p.truth[0];
  for (int k = 0; k < keyframes; ++k) {
    if (k > 0) {
      const auto i = static_cast<std::size_t>(k);
      Pose step = p.truth[i - 1].inverse() * p.truth[i];
      step.t *= scale;
      step = step * random.pose(0.01 * noise, 0.003 * noise);
      X_MR = X_MR * step;
      Matrix6d information = Matrix6d::Zero();
      information.diagonal() << Eigen::Vector3d::Constant(1.0 / (0.02 * 0.02)),
          Eigen::Vector3d::Constant(1.0 / (0.004 * 0.004));
      p.graph.pose_factors.push_back({k - 1, k, step, information, false});
    }
    p.graph.keyframes.push_back({k * 1'000'000'000LL, X_MR, X_MR, 0});
    for (int i = 0; i < 5; ++i) {
      const Plane seen = p.truth[static_cast<std::size_t>(k)].inverse() * p.planes[static_cast<std::size_t>(i)];
      const Plane measured = increment(seen, noise * Eigen::Vector3d(random.vector(0.004)));
      p.graph.plane_factors.push_back({k, i, measured, Eigen::Matrix3d::Identity() / (0.005 * 0.005)});
    }
  }
  for (std::size_t i = 0; i < 5; ++i)
    p.graph.planes.push_back(
        {increment(p.planes[i], random.vector(0.02)), i < 4 ? PlaneKind::wall : PlaneKind::floor, 0, -1});
  p.graph.rooms.push_back({RoomKind::four_wall, {0.2, -0.1}, 0});
  p.graph.room_factors.push_back({0, {0, 1, 2, 3}, {0, 0}, 0.0, Eigen::Matrix2d::Identity() * 1e4});
  return p;
}

double rmse(const Problem& p) {
  double sum = 0.0;
  for (std::size_t k = 0; k < p.truth.size(); ++k) sum += (p.graph.keyframes[k].X_MR.t - p.truth[k].t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(p.truth.size()));
}

TEST(Optimize, RecoversTheTruthWithoutNoise) {
  Problem p = make_hall(1, 1.0, 0.0);
  (void)optimize(p.graph, 1, {});
  EXPECT_LT(rmse(p), 1e-5);
  EXPECT_LT(p.graph.rooms[0].center_M.norm(), 1e-5);
}

TEST(Optimize, HalvesAPlantedScaleErrorInEverySeed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Problem p = make_hall(seed, 1.02, 1.0);
    const double before = rmse(p);
    (void)optimize(p.graph, 1, {});
    EXPECT_LT(rmse(p), 0.5 * before) << "seed " << seed;
  }
}

TEST(Optimize, LeavesKeyframesBeforeTheWindowWhereTheyAre) {
  Problem p = make_hall(3, 1.02, 1.0);
  const Graph before = p.graph;
  const OptimizeReport report = optimize(p.graph, 30, {});
  EXPECT_EQ(report.keyframes, 10);
  for (std::size_t k = 0; k < 30; ++k) EXPECT_EQ(p.graph.keyframes[k].X_MR.t, before.keyframes[k].X_MR.t);
  EXPECT_NE(p.graph.keyframes[39].X_MR.t, before.keyframes[39].X_MR.t);
  EXPECT_LT(report.final_cost, report.initial_cost);
}

TEST(Optimize, GivesTheSameBytesTwice) {
  Problem a = make_hall(4, 1.02, 1.0), b = make_hall(4, 1.02, 1.0);
  (void)optimize(a.graph, 1, {});
  (void)optimize(b.graph, 1, {});
  EXPECT_EQ(digest_of(a.graph), digest_of(b.graph));
}

TEST(Optimize, PullsDuplicatePlanesTogether) {
  Problem p = make_hall(5, 1.0, 1.0);
  // The second half of the walk took wall 0 for a new one.
  p.graph.planes.push_back(p.graph.planes[0]);
  for (PlaneFactor& f : p.graph.plane_factors)
    if (f.plane == 0 && f.keyframe >= 20) f.plane = 5;
  p.graph.duplicate_factors.push_back({0, 5, {-4.0, 0.0, 0.0}, 1e-4, 1e-4});
  (void)optimize(p.graph, 1, {});
  EXPECT_LT(duplicate_residual(p.graph.planes[0].plane_M, p.graph.planes[5].plane_M, {-4, 0, 0}).e.norm(), 1e-3);
}

}  // namespace
}  // namespace plumbline::slam
