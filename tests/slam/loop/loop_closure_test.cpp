// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/loop_closure.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/random_values.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

DeskewedScan look(const synthetic::House& house, const Pose& X_WR) {
  MotionBuffer still;
  still.add(Odometry{});
  return deskew(synthetic::standing_scan(house, X_WR, {}), still, synthetic::calibration());
}

Pose standing(double x, double y, double yaw) { return Pose::from_xyz_yaw({x, y, 0.5}, yaw); }

/// A walk from the corridor and back whose estimate has drifted by `drift` at the end; returns the loop's factor.
std::optional<PoseFactor> walk_and_return(const Pose& drift, double way_m, Pose& truth_FT, int last_storey = 0) {
  const synthetic::House house = synthetic::corridor_house();
  const std::vector<Pose> X_WR = {standing(2.0, 1.1, 0.0), standing(3.0, 1.1, 0.1), standing(8.0, 1.0, 0.0),
                                  standing(2.2, 1.2, 3.0)};
  LoopClosure loop({});
  Graph graph;
  std::optional<PoseFactor> found;
  for (std::size_t k = 0; k < X_WR.size(); ++k) {
    const Pose belief = k + 1 == X_WR.size() ? X_WR[k] * drift : X_WR[k];
    graph.keyframes.push_back({static_cast<Nanoseconds>(k), belief, belief, k + 1 == X_WR.size() ? last_storey : 0});
    found = loop.update(graph, look(house, X_WR[k]), way_m * static_cast<double>(k) / 3.0);
    if (k + 1 < X_WR.size()) {
      EXPECT_FALSE(found.has_value()) << k;
    }
  }
  truth_FT = X_WR.front().inverse() * X_WR.back();
  return found;
}

TEST(LoopClosure, MeasuresTheWayBackWithinItsSigmas) {
  for (std::uint64_t trial = 0; trial < 5; ++trial) {
    RandomValues random(1, trial);
    Pose truth_FT;
    const Pose drift =
        Pose::from_xyz_yaw({0.1 * random.gauss(), 0.1 * random.gauss(), 0.02 * random.gauss()}, 0.02 * random.gauss());
    const std::optional<PoseFactor> loop = walk_and_return(drift, 28.0, truth_FT);
    ASSERT_TRUE(loop.has_value()) << trial;
    EXPECT_EQ(loop->from, 0);
    EXPECT_EQ(loop->to, 3);
    EXPECT_TRUE(loop->loop);
    const Pose error = truth_FT.inverse() * loop->X_FT;
    Vector6d e;
    e << error.t, log_so3(error.q);
    EXPECT_LT(e.dot(loop->information * e), 22.5) << "chi2 with 6 dof, 99.9 %";
  }
}

TEST(LoopClosure, DoesNotBelieveLargeCorrectionsNorShortWays) {
  Pose truth_FT;
  EXPECT_FALSE(walk_and_return(Pose::from_xyz_yaw({0.0, 0.0, 0.0}, 0.3), 28.0, truth_FT).has_value());
  EXPECT_FALSE(walk_and_return(Pose{}, 8.0, truth_FT).has_value()) << "too short a way for a loop";
}

// The same scan that closes a loop on its own storey closes none where the robot took the stairs in between.
TEST(LoopClosure, StoreysThatLookAlikeAreNotJoined) {
  Pose truth_FT;
  ASSERT_TRUE(walk_and_return(Pose{}, 28.0, truth_FT).has_value());
  EXPECT_FALSE(walk_and_return(Pose{}, 28.0, truth_FT, 1).has_value());
  const Pose upstairs = Pose::from_xyz_yaw({0.0, 0.0, 3.0}, 0.0);
  EXPECT_FALSE(walk_and_return(upstairs, 28.0, truth_FT, 1).has_value());
  EXPECT_FALSE(walk_and_return(upstairs, 28.0, truth_FT).has_value()) << "3 m up is no drift";
}

TEST(LoopClosure, TrustedInformationOfAnUnseenDirectionIsWeak) {
  Matrix6d hessian = 1e6 * Matrix6d::Identity();
  hessian(0, 0) = 0.0;
  const Matrix6d information = trusted_information(hessian, 50.0, 0.01, 0.002);
  EXPECT_NEAR(information(0, 0), 1.0, 1e-3);  // unknown to 1 m
  EXPECT_NEAR(information(1, 1), 1.0 / (50e-6 + 1e-4), 20.0);
  EXPECT_EQ(information, information.transpose());
}

}  // namespace
}  // namespace plumbline::slam
