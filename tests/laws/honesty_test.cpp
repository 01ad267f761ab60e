// SPDX-License-Identifier: Apache-2.0
// What must be true of every estimator: it lives on what a robot's sensors gave, and on nothing else.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "bim/random/stream.h"
#include "slam/io/packets/vlp16.h"
#include "slam/methods.h"
#include "tests/laws/walk.h"

namespace plumbline {
namespace {

const SimulatedWalk& short_walk() {
  static const SimulatedWalk walk = walk_quickstart(3, {"office_a", "corridor", "kitchen"}, 14.0);
  return walk;
}

/// Its first scans, for laws that hold from the first to the last alike.
std::vector<slam::SensorFrame> first_frames() {
  const SimulatedWalk& walk = short_walk();
  return {walk.frames.begin(), walk.frames.begin() + 60};
}

class EveryMethod : public ::testing::TestWithParam<std::string> {
 protected:
  /// The method's answer to the first scans, asked once.
  [[nodiscard]] static const Answer& first_answer() {
    static std::map<std::string, Answer> answers;
    const auto known = answers.find(GetParam());
    if (known != answers.end()) return known->second;
    return answers.emplace(GetParam(), answer_of(GetParam(), method_input(short_walk(), GetParam()), first_frames()))
        .first->second;
  }
};

TEST_P(EveryMethod, AnswersTheSameAgainFromThePacketsAlone) {
  std::vector<slam::SensorFrame> decoded = first_frames();
  for (slam::SensorFrame& frame : decoded) frame.scan = slam::decode_message(frame.packets);
  const Answer again = answer_of(GetParam(), method_input(short_walk(), GetParam()), decoded);
  EXPECT_EQ(digest_of(again), digest_of(first_answer()));
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryMethod, ::testing::ValuesIn(all_methods()),
                         [](const auto& info) { return info.param; });

TEST(PlanLocalization, MovesWithThePlan) {
  const SimulatedWalk& walk = short_walk();
  const std::string method = "s_graph_localization";
  const auto input = method_input(walk, method);
  const Answer here = answer_of(method, input, walk.frames);
  ASSERT_TRUE(here.outputs.back().X_FR.has_value()) << "this walk must converge, or the law says nothing";

  const Stream stream(5, "bim.generate");
  const double angle = 2.0 * std::numbers::pi * stream.uniform(0);
  const Pose X_VW = Pose::from_xyz_yaw({20.0 * stream.gauss(1), 20.0 * stream.gauss(2), 0.0}, angle);
  auto moved = input;
  moved.plan = std::make_shared<const bim::Plan>(bim::transformed(*walk.plan, X_VW));
  moved.prior.yaw_W = wrap_angle(*input.prior.yaw_W + angle);
  const Answer there = answer_of(method, moved, walk.frames);

  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    ASSERT_EQ(here.outputs[i].X_FR.has_value(), there.outputs[i].X_FR.has_value()) << "scan " << i;
    if (!here.outputs[i].X_FR) continue;
    EXPECT_LT((X_VW * here.outputs[i].X_FR->t - there.outputs[i].X_FR->t).norm(), 1e-3) << "scan " << i;
  }
}

// No answer depends on where odometry has its origin: here 1 km away and turned by 37 degrees.
TEST_P(EveryMethod, AnswersTheSameFromAnotherOdometryFrame) {
  const SimulatedWalk& walk = short_walk();
  const auto input = method_input(walk, GetParam());
  const double degree = std::numbers::pi / 180.0;
  const Pose X_PO = Pose::from_xyz_yaw({600.0, -800.0, 0.0}, 37.0 * degree);
  const std::vector<slam::SensorFrame> frames = first_frames();
  std::vector<slam::SensorFrame> moved = frames;
  for (auto& frame : moved)
    for (auto& odometry : frame.odometry) odometry.X_OR = X_PO * odometry.X_OR;
  const Answer& here = first_answer();
  const Answer there = answer_of(GetParam(), input, moved);
  // Only dead reckoning answers in the odometry's frame.
  const Pose X_NM = GetParam() == "odometry" ? X_PO : Pose{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(here.outputs[i].X_FR.has_value(), there.outputs[i].X_FR.has_value()) << "scan " << i;
    if (!here.outputs[i].X_FR) continue;
    const Pose error = (X_NM * *here.outputs[i].X_FR).inverse() * *there.outputs[i].X_FR;
    EXPECT_LT(error.t.norm(), 1e-3) << "scan " << i;
    EXPECT_LT(log_so3(error.q).norm(), 0.01 * degree) << "scan " << i;
  }
}

TEST(SGraphsPlus, HalvesAPlantedOdometryScaleError) {
  SimulatedWalk walk = walk_quickstart(4, {"office_a", "corridor", "lab", "studio"}, 45.0);
  for (auto& frame : walk.frames)
    for (auto& odometry : frame.odometry) odometry.X_OR.t *= 1.02;
  const auto planted = rmse_from_first_pose(answer_of("odometry", method_input(walk, "odometry"), walk.frames), walk);
  const auto corrected =
      rmse_from_first_pose(answer_of("s_graphs_plus", method_input(walk, "s_graphs_plus"), walk.frames), walk);
  EXPECT_LE(corrected, 0.5 * planted) << "planted " << planted << " m, corrected " << corrected << " m";
}

}  // namespace
}  // namespace plumbline
