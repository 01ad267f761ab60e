// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/failure_signature.h"

#include <gtest/gtest.h>

#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

Tree results(const std::string& gates, const std::string& methods) {
  return read_json(R"({"gates": [)" + gates + R"(], "methods": {)" + methods + "}}", "results.json");
}

std::string gate(const std::string& method, const std::string& value, bool passed = false) {
  return R"({"metric": "ate_aligned_rmse_m", "method": ")" + method + R"(", "op": "<=", "limit": 0.1, )" +
         (value.empty() ? "" : R"("value": )" + value + ", ") + R"("passed": )" + (passed ? "true" : "false") + "}";
}

std::string localization(const std::string& verdict, const std::string& evidence, const std::string& cause) {
  return R"("plan": {"verdict": ")" + verdict + R"(", "localization": {"evidence": ")" + evidence +
         (cause.empty() ? "" : R"(", "failure": ")" + cause) + R"("}})";
}

const std::string complete = R"("slam": {"verdict": "complete"})";

TEST(FailureSignature, GoodVerdictsAndPassedGatesAreNoFailures) {
  for (const char* verdict : {"success", "honest_ambiguity"})
    EXPECT_TRUE(failures_in(results(gate("slam", "0.05", true), complete + ", " + localization(verdict, "unique", "")))
                    .empty());
  EXPECT_EQ(failures_in(results("", localization("lucky", "ambiguous", ""))).size(), 1U);
}

TEST(FailureSignature, OfABadVerdictTheVerdictIsTakenNotItsGate) {
  const Tree run = results(gate("plan", "0.5") + ", " + gate("slam", "0.2"),
                           complete + ", " + localization("late", "unique", "undecided"));
  const auto failures = failures_in(run);
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_EQ(failures[0].verdict, "late");
  EXPECT_FALSE(failures[0].gate);
  EXPECT_EQ(failures[1].method, "slam");
  ASSERT_TRUE(failures[1].gate);
  EXPECT_EQ(chosen_failure(run, "run", "", "").method, "plan");
  EXPECT_EQ(chosen_failure(run, "run", "slam", "").method, "slam");
  const FailureSignature by_gate = chosen_failure(run, "run", "plan", "ate_aligned_rmse_m");
  EXPECT_TRUE(by_gate.gate && by_gate.verdict == "late");
}

TEST(FailureSignature, VerdictEvidenceAndCauseMustAllBeTheSame) {
  const auto of = [](const char* verdict, const char* evidence, const char* cause) {
    return results("", localization(verdict, evidence, cause));
  };
  const Tree run = of("false_convergence", "unique", "twin_preferred");
  const FailureSignature failure = failures_in(run).front();
  EXPECT_EQ(difference_to(failure, run), "");
  EXPECT_EQ(difference_to(failure, of("late", "unique", "twin_preferred")), "verdict late");
  EXPECT_EQ(difference_to(failure, of("false_convergence", "ambiguous", "twin_preferred")), "evidence ambiguous");
  EXPECT_EQ(difference_to(failure, of("false_convergence", "unique", "wrong_model")), "cause wrong_model");
  EXPECT_EQ(difference_to(failure, of("false_convergence", "unique", "")), "cause absent");
  EXPECT_NE(difference_to(failure, results("", complete)), "");
}

TEST(FailureSignature, AGateFailsAgainByHalfOfItsExcess) {
  const auto of = [](const std::string& value, bool passed) { return results(gate("slam", value, passed), complete); };
  const FailureSignature failure = failures_in(of("0.3", false)).front();
  EXPECT_EQ(difference_to(failure, of("0.5", false)), "");
  EXPECT_EQ(difference_to(failure, of("0.2", false)), "");
  EXPECT_NE(difference_to(failure, of("0.19", false)), "");
  EXPECT_NE(difference_to(failure, of("0.05", true)), "");
  EXPECT_EQ(difference_to(failure, of("", false)), "the metric is absent");
  EXPECT_EQ(difference_to(failure, results("", complete)), "the gate is not judged");
  const FailureSignature absent = failures_in(of("", false)).front();
  EXPECT_EQ(difference_to(absent, of("", false)), "");
  EXPECT_EQ(difference_to(absent, of("0.5", false)), "the metric has a value");
}

TEST(FailureSignature, CrashesAreTheSameUpToTheirNumbers) {
  const auto of = [](const std::string& error) {
    return results("", R"("slam": {"verdict": "crashed", "error": ")" + error + R"("})");
  };
  const FailureSignature failure = failures_in(of("no plane in 12 of 340 scans")).front();
  EXPECT_EQ(difference_to(failure, of("no plane in 7 of 9 scans")), "");
  EXPECT_NE(difference_to(failure, of("out of memory")), "");
}

TEST(FailureSignature, WhatDoesNotFailIsRefused) {
  const auto error = [](const Tree& run, const char* method, const char* metric) {
    return input_error([&] { (void)chosen_failure(run, "runs/a", method, metric); });
  };
  const Tree good = results(gate("slam", "0.05", true), complete);
  EXPECT_EQ(error(good, "", ""), "runs/a: does not fail: every verdict is good and no gate failed");
  const Tree bad = results(gate("slam", "0.3"), complete + ", " + localization("success", "unique", ""));
  EXPECT_NE(error(bad, "slan", "").find("did you mean 'slam'?"), std::string::npos);
  EXPECT_NE(error(bad, "plan", "").find("'plan' does not fail in this run; what fails is slam: "), std::string::npos);
  EXPECT_NE(error(bad, "", "rooms.recall").find("no gate on 'rooms.recall' failed"), std::string::npos);
  Tree fell = bad;
  fell.set("failure", "the robot fell");
  EXPECT_NE(error(fell, "", "").find("the walk itself failed"), std::string::npos);
  EXPECT_EQ(difference_to(failures_in(bad).front(), fell), "the walk fails: the robot fell");
}

}  // namespace
}  // namespace plumbline::scenarios
