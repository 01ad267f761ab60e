// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/plan_method.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "slam/methods.h"
#include "tests/slam/baselines/plan_walk.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

class Baseline : public testing::TestWithParam<std::string> {};

bool finite(const Pose& X) { return X.t.allFinite() && X.q.coeffs().allFinite(); }

void expect_finite(const synthetic::PlanWalkAnswers& answers) {
  for (const Output& output : answers.outputs) {
    if (output.X_FR) {
      EXPECT_TRUE(finite(*output.X_FR));
    }
    double mass = 0.0;
    for (const Hypothesis& hypothesis : output.hypotheses) {
      EXPECT_TRUE(finite(hypothesis.X_WR) && hypothesis.covariance.allFinite());
      mass += hypothesis.mass;
    }
    EXPECT_LT(mass, 1.0 + 1e-6);
    EXPECT_LE(output.particles.size(), 500U);
  }
}

const synthetic::Recording& recording() {
  static const synthetic::Recording recording = synthetic::biased_walk(1.5);
  return recording;
}

TEST_P(Baseline, APlanWithoutWallsNeverConverges) {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  plan.faces.clear();
  for (bim::PlanRoom& room : plan.rooms) room.faces.clear();
  const auto answers = synthetic::localize(GetParam(), recording(), plan, false);
  expect_finite(answers);
  for (const Output& output : answers.outputs) EXPECT_NE(output.state, State::converged);
}

TEST_P(Baseline, APlanOfSomewhereElseAndSeveralStoreysGiveFiniteAnswers) {
  bim::Plan plan = synthetic::plan_of(synthetic::twin_rooms());
  expect_finite(synthetic::localize(GetParam(), recording(), plan, true));
  bim::Plan tower = synthetic::plan_of(synthetic::one_room());
  const bim::Plan above = synthetic::moved(tower, Pose::from_xyz_yaw({0.0, 0.0, 3.0}, 0.0));
  tower.storeys.push_back({"upper", 3.0, 2.8});
  for (bim::PlanFace face : above.faces) {
    face.storey = 1;
    tower.faces.push_back(face);
  }
  tower.rooms.push_back(above.rooms.front());
  tower.rooms.back().storey = 1;
  tower.rooms.back().name = "upstairs";
  expect_finite(synthetic::localize(GetParam(), recording(), tower, false));
}

TEST_P(Baseline, APlanWithoutRoomsIsRefused) {
  bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  plan.rooms.clear();
  EXPECT_THROW(static_cast<void>(synthetic::localize(GetParam(), recording(), plan, true)), InputError);
}

// The paper's compares planes in W, and so depends on where that is.
class BaselineButThePapers : public Baseline {};

TEST_P(BaselineButThePapers, MovesWithThePlan) {
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const Pose X_VW = Pose::from_xyz_yaw({17.0, -40.0, 6.0}, 2.1);
  const auto here = synthetic::localize(GetParam(), recording(), plan, false);
  const auto there = synthetic::localize(GetParam(), recording(), synthetic::moved(plan, X_VW), false);
  ASSERT_FALSE(here.outputs.empty());
  ASSERT_EQ(here.outputs.size(), there.outputs.size());
  std::size_t compared = 0;
  for (std::size_t k = 0; k < here.outputs.size(); ++k) {
    ASSERT_EQ(here.outputs[k].state, there.outputs[k].state);
    ASSERT_EQ(here.outputs[k].hypotheses.size(), there.outputs[k].hypotheses.size());
    for (std::size_t i = 0; i < here.outputs[k].hypotheses.size(); ++i) {
      const Hypothesis &a = here.outputs[k].hypotheses[i], &b = there.outputs[k].hypotheses[i];
      EXPECT_NEAR(a.mass, b.mass, 1e-6);
      EXPECT_LT((X_VW * a.X_WR.t - b.X_WR.t).norm(), 1e-3);
      ++compared;
    }
  }
  EXPECT_GT(compared, 0U);
}

INSTANTIATE_TEST_SUITE_P(PlanMethod, Baseline, testing::Values("s_graph_localization_paper", "amcl", "ukf", "micp"),
                         [](const auto& info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(PlanMethod, BaselineButThePapers, testing::Values("amcl", "ukf", "micp"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace plumbline::slam
