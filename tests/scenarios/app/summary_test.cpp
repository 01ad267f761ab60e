// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/summary.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

/// Two methods: one judged by a gate that fails at 4 s, one that no gate judges.
struct Judged {
  FinishedRun run;
  score::RunScore score;
  Judged() {
    score.duration_s = 9.0;
    for (const char* name : {"judged", "un judged"}) {
      score::MethodScore& method = score.methods.emplace_back();
      method.name = name;
      method.verdict = "success";
    }
  }
  void fail() {
    score::GateResult& gate = score.gates.emplace_back();
    gate.metric = "ate_rmse_m";
    gate.method = "judged";
    gate.see = "#t=4&m=judged";
  }
  std::string steps(bool has_replay) const { return next_steps("runs/a b", has_replay, run, score); }
};

TEST(NextSteps, OfARunThatPassedNameThePageWhereThereIsOne) {
  const Judged judged;
  EXPECT_EQ(judged.steps(false), "");
  EXPECT_EQ(judged.steps(true), "look:  runs/a b/replay.html\n");
}

TEST(NextSteps, OfABadMethodThatNoGateJudgesLeadToIt) {
  Judged judged;
  judged.score.methods[1].verdict = "overconfident";
  EXPECT_EQ(judged.steps(true), "look:  runs/a b/replay.html#m=un%20judged\n");
  EXPECT_EQ(judged.steps(false), "look:  plumbline report --3d 'runs/a b'\n");
  EXPECT_NE(summarise(judged.run, judged.score).find("\nnot judged: un judged: overconfident\nno gates\n"),
            std::string::npos);
}

TEST(NextSteps, LeadToEveryMethodThatFailed) {
  Judged judged;
  judged.fail();
  judged.fail();  // a second gate of the same method says nothing more
  judged.score.methods[1].verdict = "late";
  EXPECT_EQ(judged.steps(true),
            "look:  runs/a b/replay.html#t=4&m=judged\nlook:  runs/a b/replay.html#m=un%20judged\n"
            "again: plumbline replay 'runs/a b' --until 9\n");
}

TEST(NextSteps, OfACrashLeadToTheMethodAndItsLastScan) {
  Judged judged;
  for (const char* name : {"judged", "un judged"}) judged.run.record.methods.emplace_back().name = name;
  judged.run.record.methods[1].crashed = true;
  judged.run.record.methods[1].causal = {{3'000'000'000, {}}};
  judged.score.methods[1].verdict = "crashed";
  EXPECT_EQ(exit_code(judged.run, judged.score), 1);
  EXPECT_EQ(judged.steps(true),
            "look:  runs/a b/replay.html#m=un%20judged\nagain: plumbline replay 'runs/a b' --until 3\n");
  EXPECT_NE(summarise(judged.run, judged.score).find("\nFAILED: un judged: crashed\nno gates\n"), std::string::npos);
}

// No replay stops at 0.
TEST(NextSteps, OfAMethodThatNeverStartedReplayAll) {
  Judged judged;
  for (const char* name : {"judged", "un judged"}) judged.run.record.methods.emplace_back().name = name;
  judged.run.record.methods[1].crashed = true;
  judged.score.methods[1].verdict = "crashed";
  EXPECT_EQ(judged.steps(true), "look:  runs/a b/replay.html#m=un%20judged\nagain: plumbline replay 'runs/a b'\n");
}

TEST(NextSteps, OfSlamThatIsFarOffLeadToIt) {
  Judged judged;
  judged.score.methods[1].verdict = "complete";
  score::TrajectoryScore& off = judged.score.methods[1].trajectory.emplace();
  off.ate_aligned_rmse_m = 2.0;
  EXPECT_EQ(exit_code(judged.run, judged.score), 0);
  EXPECT_EQ(judged.steps(true), "look:  runs/a b/replay.html#m=un%20judged\n");
  EXPECT_NE(summarise(judged.run, judged.score).find("\nnot judged: un judged: off by 2 m rms\n"), std::string::npos);
}

TEST(NextSteps, NameNoPageThatIsNotThere) {
  Judged judged;
  judged.run.record.failure = "the robot fell";
  EXPECT_EQ(judged.steps(false),
            "look:  plumbline report --3d 'runs/a b'\nagain: plumbline replay 'runs/a b' --until 9\n");
}

TEST(Summary, GivesTheTimeOfConvergenceOnTheRunsClock) {
  Judged judged;
  judged.run.scans = {100'000'000, 200'000'000};
  judged.score.methods[0].localization.emplace().converged_at_s = 3.3;
  EXPECT_NE(summarise(judged.run, judged.score).find("      3.4\n"), std::string::npos)
      << summarise(judged.run, judged.score);
}

TEST(Summary, SaysWhatItsColumnsDoNotShow) {
  Judged judged;
  EXPECT_EQ(summarise(judged.run, judged.score).find("note: "), std::string::npos);
  judged.score.methods[0].tracking.emplace().lost_share = 0.953;
  score::RoomScore& rooms = judged.score.methods[1].rooms.emplace();
  rooms.found = 5;
  rooms.matched = 3;
  const std::string text = summarise(judged.run, judged.score);
  EXPECT_NE(text.find("\nnote: judged: LOST at 95 % of the scans\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nnote: un judged: 2 of the 5 rooms that it found match none of the building\n"),
            std::string::npos)
      << text;
}

TEST(NextSteps, OfAFallLeadToTheEnd) {
  Judged judged;
  judged.run.record.failure = "the robot fell";
  EXPECT_EQ(judged.steps(true).rfind("look:  runs/a b/replay.html#t=9\n", 0), 0U);
}

TEST(Summary, WarnsOfAnAnswerThatIsSureAndWrongWhereNoGateAsksForIt) {
  Judged judged;
  score::LocalizationScore& where = judged.score.methods[1].localization.emplace();
  const auto says = [&](const std::string& text) {
    return summarise(judged.run, judged.score).find("warning: un judged: CONVERGED " + text) != std::string::npos;
  };
  where.verdict = score::LocalizationVerdict::success;
  EXPECT_FALSE(says(""));
  where.verdict = score::LocalizationVerdict::overconfident;
  where.ape_rmse_m = 15.46;
  where.yaw_rmse_deg = 90.2;
  const std::string gate = "; no gate asks for it: localization.sure_and_wrong<=0\n";
  EXPECT_TRUE(says("on a wrong pose, 15.5 m and 90.2 deg off rms" + gate)) << summarise(judged.run, judged.score);
  where.ape_rmse_m = where.yaw_rmse_deg = 0.1;
  EXPECT_TRUE(says("on one pose, which the scans do not distinguish from others" + gate));
  where.verdict = score::LocalizationVerdict::false_convergence;
  EXPECT_TRUE(says("on a wrong pose, "));
  score::GateResult& asked = judged.score.gates.emplace_back();
  asked.method = "un judged";
  asked.metric = "ate_rmse_m";
  asked.passed = true;
  EXPECT_TRUE(says("")) << "the gate asks for another thing";
  asked.metric = "localization.sure_and_wrong";
  EXPECT_FALSE(says(""));
}

TEST(Summary, WarnsOfAWrongAnswerAfterAKidnappingWhereNoGateAsksForIt) {
  Judged judged;
  score::LocalizationScore& where = judged.score.methods[1].localization.emplace();
  where.verdict = score::LocalizationVerdict::success;
  where.converged_at_s = 6.0;
  const auto says = [&] {
    return summarise(judged.run, judged.score)
               .find(
                   "warning: un judged: CONVERGED on a wrong pose for up to 4.5 s after the kidnapping; no gate asks "
                   "for it: localization.kidnap_wrong_s<=0\n") != std::string::npos;
  };
  where.kidnap_wrong_s = 0.0;
  EXPECT_FALSE(says());
  where.kidnap_wrong_s = 4.52;
  EXPECT_TRUE(says()) << summarise(judged.run, judged.score);
  score::GateResult& asked = judged.score.gates.emplace_back();
  asked.method = "un judged";
  asked.metric = "localization.sure_and_wrong";
  asked.passed = true;
  EXPECT_TRUE(says()) << "that gate is of the verdict, which is of the time before";
  asked.metric = "localization.kidnap_wrong_s";
  EXPECT_FALSE(says());
  judged.score.gates.clear();
  where.kidnap_found_s = 5.0;
  EXPECT_FALSE(says()) << "it noticed";
}

}  // namespace
}  // namespace plumbline::scenarios
