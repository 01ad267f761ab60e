// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/blame.h"

#include <gtest/gtest.h>

#include "scenarios/hunt/hunt.h"

namespace plumbline::scenarios {
namespace {

std::string localization(const std::string& verdict, const std::string& evidence) {
  return R"("plan": {"verdict": ")" + verdict + R"(", "localization": {"evidence": ")" + evidence +
         R"(", "ape_rmse_m": 0.5}})";
}

std::string slam(const std::string& name, const std::string& verdict, const std::string& error) {
  return "\"" + name + R"(": {"verdict": ")" + verdict + "\"" +
         (error.empty() ? "" : R"(, "ate_aligned_rmse_m": )" + error) + "}";
}

Tree results(const std::string& methods, const std::string& gates = "") {
  return read_json(R"({"gates": [)" + gates + R"(], "methods": {)" + methods + "}}", "results.json");
}

std::string failed_gate(const std::string& method) {
  return R"({"metric": "ate_aligned_rmse_m", "method": ")" + method +
         R"(", "op": "<=", "limit": 0.1, "passed": false})";
}

/// Of the first failure.
bool is_blamed(const Tree& run) { return blame_of(failures_in(run).at(0), run).of_method; }

TEST(Blame, SureAndWrongIsTheMethodsWhateverTheEvidence) {
  for (const char* evidence : {"unique", "weak", "ambiguous"}) {
    for (const char* verdict : {"false_convergence", "overconfident", "crashed"})
      EXPECT_TRUE(is_blamed(results(localization(verdict, evidence)))) << verdict << evidence;
    EXPECT_FALSE(is_blamed(results(localization("lucky", evidence)))) << evidence;
  }
}

TEST(Blame, LateAndLostAreTheMethodsWhereThePoseIsDetermined) {
  for (const char* verdict : {"late", "lost"}) {
    EXPECT_TRUE(is_blamed(results(localization(verdict, "unique")))) << verdict;
    EXPECT_FALSE(is_blamed(results(localization(verdict, "weak")))) << verdict;
    EXPECT_FALSE(is_blamed(results(localization(verdict, "ambiguous")))) << verdict;
  }
}

TEST(Blame, OfLostSlamAnotherMethodShowsThatItCouldBeTracked) {
  const std::string lost = slam("a", "lost", "");
  EXPECT_TRUE(is_blamed(results(lost + ", " + slam("b", "complete", "0.4"))));
  EXPECT_FALSE(is_blamed(results(lost + ", " + slam("b", "complete", "0.6"))));
  EXPECT_FALSE(is_blamed(results(lost + ", " + slam("b", "lost", ""))));
  EXPECT_FALSE(is_blamed(results(lost + ", " + slam("truth", "complete", "0"))));
  EXPECT_FALSE(is_blamed(results(lost + ", " + localization("success", "unique"))));
  EXPECT_FALSE(is_blamed(results(lost)));
}

TEST(Blame, OfAFailedGateAnotherMethodKeepsTheBound) {
  const std::string far = slam("a", "complete", "0.3");
  EXPECT_TRUE(is_blamed(results(far + ", " + slam("b", "complete", "0.1"), failed_gate("a"))));
  EXPECT_FALSE(is_blamed(results(far + ", " + slam("b", "complete", "0.2"), failed_gate("a"))));
  EXPECT_FALSE(is_blamed(results(far + ", " + slam("truth", "complete", "0"), failed_gate("a"))));
}

TEST(Badness, GrowsFromWellDoneToFaultsToCrashes) {
  const auto badness = [](const Tree& run) { return outcomes_of(run).front().badness; };
  const double fine = badness(results(slam("a", "complete", "0.01")));
  const double poor = badness(results(slam("a", "complete", "0.5")));
  EXPECT_LT(fine, poor);
  EXPECT_DOUBLE_EQ(poor, 0.5);
  EXPECT_DOUBLE_EQ(badness(results(localization("false_convergence", "unique"))), 1.5);
  EXPECT_DOUBLE_EQ(badness(results(localization("late", "ambiguous"))), 0.0);
  EXPECT_DOUBLE_EQ(badness(results(slam("a", "crashed", ""))), 2.0);
  EXPECT_DOUBLE_EQ(died("a", "signal 11").badness, 2.0);
}

TEST(Outcomes, LeaveOutTheTruthAndPreferAFaultOfTheMethod) {
  const Tree run = results(
      slam("truth", "complete", "0") + ", " + slam("a", "complete", "0.3") + ", " + slam("b", "complete", "0.05"),
      R"({"metric": "rooms.recall", "method": "a", "op": ">=", "limit": 1, "passed": false}, )" + failed_gate("a"));
  const std::vector<MethodOutcome> outcomes = outcomes_of(run);
  ASSERT_EQ(outcomes.size(), 2U);
  ASSERT_TRUE(outcomes[0].failure);
  EXPECT_EQ(outcomes[0].failure->gate->metric, "ate_aligned_rmse_m");
  EXPECT_EQ(outcomes[0].blame.why, "b kept the same bound");
  EXPECT_FALSE(outcomes[1].failure);
}

/// A run of a scenario with this heading, whose method ended so.
HuntRun hunt_run(const std::string& yaw, const std::string& verdict, const std::string& evidence, double badness) {
  HuntRun run;
  run.run = RunCase{read_yaml("scenario: 1\nbuilding: a.plan.yaml\nprior: {yaw: " + yaw + "}\n", "a.yaml"), "a",
                    std::make_shared<const std::string>()};
  run.outcomes = outcomes_of(results(localization(verdict, evidence)));
  run.outcomes.front().badness = badness;
  return run;
}

TEST(Findings, AreOneOfEachKindTheSeverestAndWorstFirst) {
  HuntResult result;
  result.runs = {hunt_run("known", "late", "unique", 1.9),
                 hunt_run("known", "false_convergence", "unique", 1.2),
                 hunt_run("known", "false_convergence", "weak", 1.6),
                 hunt_run("unknown", "false_convergence", "weak", 1.7),
                 hunt_run("known", "late", "ambiguous", 0.0),
                 hunt_run("known", "success", "unique", 0.1)};
  summarize(result);
  ASSERT_EQ(result.findings.size(), 3U);
  EXPECT_EQ(result.findings[0].worst, 3U);
  EXPECT_EQ(result.findings[1].worst, 2U);
  EXPECT_EQ(result.findings[1].runs, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(result.findings[2].failure.verdict, "late");
  ASSERT_EQ(result.excused.size(), 1U);
  EXPECT_EQ(result.excused.begin()->second, 1);
}

}  // namespace
}  // namespace plumbline::scenarios
