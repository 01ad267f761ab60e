// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/methods_alone.h"

#include <gtest/gtest.h>

#include <csignal>
#include <map>

#include "scenarios/hunt/hunt.h"

namespace plumbline::scenarios {
namespace {

RunCase three_methods() {
  return {read_yaml("scenario: 1\nbuilding: a.plan.yaml\nmethods: [truth, a, b]\n", "a.yaml"), "a.plan.yaml",
          std::make_shared<const std::string>()};
}

Trial ended_by(int signal) { return {std::nullopt, signal, false, "signal " + std::to_string(signal)}; }

Trial good(const std::string& method) {
  Trial trial;
  trial.results = read_json(R"({"gates": [], "methods": {")" + method + R"(": {"verdict": "complete"}}})", "r.json");
  return trial;
}

/// What is found of a run that a segmentation fault ended, where these methods end so alone.
MethodsAlone alone(std::map<std::string, int> signals, int together = SIGSEGV) {
  return methods_alone(three_methods(), ended_by(together), [&](const std::vector<RunCase>& cases, const auto&) {
    std::vector<Trial> trials;
    for (const RunCase& run : cases) {
      const std::string method = methods_of_case(run).at(0);
      trials.push_back(signals[method] != 0 ? ended_by(signals[method]) : good(method));
    }
    return trials;
  });
}

TEST(MethodsAlone, TheOneThatEndsTheProgramIsAtFault) {
  const MethodsAlone found = alone({{"b", SIGSEGV}});
  ASSERT_EQ(found.outcomes.size(), 2U);
  EXPECT_FALSE(found.outcomes[0].failure);
  EXPECT_EQ(found.outcomes[1].method, "b");
  EXPECT_TRUE(found.outcomes[1].blame.of_method);
  EXPECT_EQ(found.why, "");
}

TEST(MethodsAlone, WhereNoneEndsItAloneTheWalkFailed) {
  const MethodsAlone found = alone({});
  EXPECT_TRUE(found.outcomes.empty());
  EXPECT_EQ(found.why, "signal 11, but with no method alone");
}

TEST(MethodsAlone, AWalkThatEndsItWithTheTruthIsNoMethodsFault) {
  const MethodsAlone found = alone({{"truth", SIGSEGV}, {"a", SIGSEGV}, {"b", SIGSEGV}});
  EXPECT_TRUE(found.outcomes.empty());
  EXPECT_NE(found.why.find("with the truth alone, too"), std::string::npos) << found.why;
}

TEST(MethodsAlone, BeingKilledIsNoMethodsFault) {
  EXPECT_TRUE(alone({{"a", SIGSEGV}}, SIGKILL).outcomes.empty());
  EXPECT_NE(alone({{"a", SIGSEGV}}, SIGKILL).why, "");
  EXPECT_TRUE(alone({{"a", SIGKILL}}).outcomes.empty());
  const MethodsAlone found = alone({{"a", SIGKILL}, {"b", SIGSEGV}});
  ASSERT_EQ(found.outcomes.size(), 1U);
  EXPECT_EQ(found.outcomes[0].method, "b");
}

TEST(MethodsAlone, AFindingOfOneIsThatMethodsRun) {
  HuntResult result;
  result.runs.resize(1);
  result.runs[0].run = three_methods();
  HuntFinding finding;
  finding.failure.method = "b";
  EXPECT_EQ(methods_of_case(case_of(result, finding)).size(), 3U);
  result.runs[0].alone = true;
  EXPECT_EQ(methods_of_case(case_of(result, finding)), std::vector<std::string>{"b"});
}

}  // namespace
}  // namespace plumbline::scenarios
