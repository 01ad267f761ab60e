// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/moment.h"

#include <gtest/gtest.h>

#include "scenarios/spec/scenario.h"
#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

/// A localization that failed at the first scan, answers from 2 s on, and is 2 m off from 3.04 s on.
struct Failed {
  FinishedRun run;
  RunScore score;
  Failed() {
    score.truth = straight_walk(60, {0.0, 0.0, 0.3}, 0.05);
    MethodRecord& method = run.record.methods.emplace_back();
    method.name = "finder & co";
    method.localization = true;
    for (const slam::StampedPose& pose : score.truth.poses_W) {
      if (pose.stamp < 2'000'000'000) continue;
      method.causal.push_back(pose);
      if (pose.stamp > 3'040'000'000) method.causal.back().X_FR.t.y() += 2.0;
    }
    LocalizationScore& where = score.methods.emplace_back().localization.emplace();
    where.failure_at_s = 0.1;
  }
};

GateResult gate(std::optional<double> value) {
  return judge_gate({"ate_rmse_m", "finder & co", 0.1, std::nullopt}, "finder & co", value);
}

TEST(Moment, OfAnAbsentMetricIsTheFailureOrNothing) {
  Failed failed;
  EXPECT_NEAR(telling_moment(failed.run, failed.score, gate(std::nullopt)).value(), 3.1, 1e-9);
  failed.score.methods[0].localization->failure_at_s.reset();
  EXPECT_TRUE(telling_moment(failed.run, failed.score, gate(2.0)));
  EXPECT_FALSE(telling_moment(failed.run, failed.score, gate(std::nullopt)));
  EXPECT_EQ(moment_link(failed.run, failed.score, gate(std::nullopt)), "");
}

TEST(Moment, IsTheFirstWrongAnswerAfterAFailure) {
  const Failed failed;
  EXPECT_NEAR(telling_moment(failed.run, failed.score, "finder & co").value(), 3.1, 1e-9);
  EXPECT_EQ(moment_link(failed.run, failed.score, gate(1.0)), "#t=3.1&m=finder%20%26%20co");
}

TEST(Moment, IsTheFailureWhereNoAnswerIsWrongAfterIt) {
  Failed failed;
  failed.score.methods[0].localization->failure_at_s = 5.97;
  EXPECT_NEAR(telling_moment(failed.run, failed.score, "finder & co").value(), 5.97, 1e-9);
  // Rounded up: before, nothing has happened yet.
  EXPECT_EQ(moment_link(failed.run, failed.score, gate(1.0)).substr(0, 6), "#t=6&m");
}

}  // namespace
}  // namespace plumbline::scenarios::score
