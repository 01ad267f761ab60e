// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/micp/micp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/errors.h"
#include "tests/slam/baselines/plan_walk.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

using synthetic::localize;

TEST(Micp, TracksFromAGivenStartAndFromNone) {
  const synthetic::Recording recording = synthetic::biased_walk(4.0);
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const Pose& X_WR = recording.truth.front().X_FR;
  const std::string start = "start: {given: true, x_m: " + std::to_string(X_WR.t.x() + 0.2) +
                            ", y_m: " + std::to_string(X_WR.t.y() - 0.2) +
                            ", yaw_deg: " + std::to_string(X_WR.yaw() * 180.0 / 3.14159265 + 5.0) + "}";
  for (const std::string& config : {start, std::string()}) {
    const auto answers = localize("micp", recording, plan, false, config);
    EXPECT_EQ(answers.outputs.back().state, State::converged);
    EXPECT_LT(synthetic::last_error(answers, recording), 0.05);
  }
}

// Two closed rooms that are alike, each by half a turn like itself: four poses that nothing separates.
TEST(Micp, KeepsPlacesThatLookAlike) {
  synthetic::WalkConfig walk;
  walk.duration_s = 1.0;
  const synthetic::Recording recording = synthetic::walk(synthetic::twin_rooms(), {{1.0, 1.0}, {3.5, 2.0}}, walk);
  const auto answers = localize("micp", recording, synthetic::plan_of(synthetic::twin_rooms()), false);
  EXPECT_EQ(answers.outputs.back().state, State::ambiguous);
  EXPECT_FALSE(answers.outputs.back().X_FR.has_value());
  EXPECT_EQ(answers.outputs.back().hypotheses.size(), 4U);
  for (const Hypothesis& hypothesis : answers.outputs.back().hypotheses) EXPECT_NEAR(hypothesis.mass, 0.25, 0.1);
}

TEST(Micp, IsLostWhereBeamsDoNotFit) {
  const synthetic::Recording recording = synthetic::biased_walk(1.5);
  const auto answers = localize("micp", recording, synthetic::plan_of(synthetic::one_room(30.0, 25.0)), true,
                                "lost_updates: 3\nplan: {update_m: 0}\nstart: {given: true, x_m: 15, y_m: 12}");
  EXPECT_EQ(answers.outputs.back().state, State::lost);
}

// variance = 1 - exp(-10 |t|) cos^2(angle / 2) inliers + pose_noise, a quarter of it for the yaw.
TEST(Micp, CovarianceIsTheReferencesOwn) {
  const Eigen::Matrix3d still = micp_covariance({}, 1.0, 0.01);
  EXPECT_NEAR(still(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(still(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(still(2, 2), 0.0025, 1e-12);
  EXPECT_EQ(still(0, 1), 0.0);
  EXPECT_NEAR(micp_covariance({}, 0.7, 0.01)(0, 0), 0.31, 1e-12);
  const Pose shift{Eigen::Quaterniond::Identity(), {0.0, 0.1, 0.0}};
  EXPECT_NEAR(micp_covariance(shift, 1.0, 0.01)(0, 0), 1.01 - std::exp(-1.0), 1e-12);
  const Pose turn{exp_so3({0.0, 0.0, 1.0}), Eigen::Vector3d::Zero()};
  EXPECT_NEAR(micp_covariance(turn, 1.0, 0.01)(0, 0), 1.01 - std::pow(std::cos(0.5), 2), 1e-12);
}

TEST(Micp, CovarianceOfATrackIsThatOfItsCorrection) {
  const synthetic::Recording recording = synthetic::biased_walk(4.0);
  const auto answers = localize("micp", recording, synthetic::plan_of(synthetic::corridor_house()), true);
  const Eigen::Matrix3d& P = answers.outputs.back().hypotheses.front().covariance;
  EXPECT_GT(P(0, 0), 0.01) << "the noise of a pose";
  EXPECT_LT(P(0, 0), 0.6) << "beams agree and corrections are centimetres";
  EXPECT_DOUBLE_EQ(P(2, 2), 0.25 * P(0, 0));
}

TEST(Micp, SaysWhatIsMissing) { EXPECT_THROW(static_cast<void>(make_micp({})), InputError); }

}  // namespace
}  // namespace plumbline::slam
