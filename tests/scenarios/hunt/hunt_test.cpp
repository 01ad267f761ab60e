// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "scenarios/host/interrupt.h"
#include "scenarios/hunt/hunt_text.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

/// Of all runs alike: its method ends so.
Trial ended(const std::string& verdict) {
  Trial trial;
  trial.results = read_json(R"({"gates": [], "methods": {"vgicp": {"verdict": ")" + verdict + R"("}}})", "r.json");
  return trial;
}

/// Hunts whose runs are answered by the test.
class HuntSearches : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "work");
    for (const char* name : {"quickstart.yaml", "quickstart.plan.yaml"})
      fs::copy_file(project_file("scenarios/library/") + name, folder_ / name);
  }
  [[nodiscard]] Hunt read(const std::string& text) const {
    std::ofstream(folder_ / "hunt.yaml") << text;
    return read_hunt(folder_ / "hunt.yaml");
  }
  [[nodiscard]] HuntResult run(const Hunt& hunt, const TryCases& try_all) const {
    return run_hunt(hunt, {folder_ / "work", 1, {}, try_all}, slam::methods());
  }
  [[nodiscard]] HuntResult run(const Hunt& hunt, const Trial& of_all) const {
    return run(
        hunt, [&](const std::vector<RunCase>& cases, const auto&) { return std::vector<Trial>(cases.size(), of_all); });
  }

  Folder folder_;
};

const std::string twenty =
    "hunt: 1\nscenarios: [quickstart.yaml]\nmethods: [vgicp]\nruns: 20\n"
    "vary: [{key: prior.yaw, values: [known, unknown]}]\n";

TEST_F(HuntSearches, InterruptedWhileItExploresItKeepsWhatIsDone) {
  int calls = 0;
  const HuntResult result =
      run(read(twenty + "refine: 0\n"), [&](const std::vector<RunCase>& cases, const auto&) -> std::vector<Trial> {
        if (++calls == 3) throw Interrupted(SIGINT);
        return std::vector<Trial>(cases.size(), ended("complete"));
      });
  EXPECT_EQ(result.signal, SIGINT);
  EXPECT_EQ(result.runs.size(), 16U);
}

TEST_F(HuntSearches, NoRunIsMadeTwice) {
  const HuntResult result = run(read(twenty), ended("complete"));
  std::set<std::pair<std::uint64_t, std::string>> runs;
  for (const HuntRun& one : result.runs) runs.insert({one.seed, one.values.front().second});
  EXPECT_EQ(runs.size(), 20U);
}

TEST_F(HuntSearches, WalksThatAllFailAreAResultAndInputErrorsAreNot) {
  Trial fell{std::nullopt, 0, false, "the robot fell"};
  const HuntResult result = run(read(twenty), fell);
  EXPECT_FALSE(any_walked(result));
  EXPECT_EQ(result.runs.front().why, "the robot fell");
  EXPECT_TRUE(any_walked(run(read(twenty), ended("complete"))));
  Trial refused{std::nullopt, 0, true, "no such room"};
  const std::string error = input_error([&] { (void)run(read(twenty), refused); });
  EXPECT_NE(error.find("no run can be made; the first: no such room"), std::string::npos) << error;
}

TEST_F(HuntSearches, BuildingsAreKeptOfFindingsAlone) {
  const Hunt hunt = read("hunt: 1\nmethods: [vgicp]\nruns: 3\nrefine: 0\ngenerate: [{family: corridor}]\n");
  std::vector<RunCase> made;
  const HuntResult result = run(hunt, [&](const std::vector<RunCase>& cases, const auto&) {
    made = cases;
    return std::vector<Trial>(cases.size(), ended("crashed"));
  });
  ASSERT_EQ(result.findings.size(), 1U);
  const std::size_t worst = result.findings.front().worst;
  for (std::size_t i = 0; i < result.runs.size(); ++i) EXPECT_EQ(result.runs[i].run->bytes != nullptr, i == worst) << i;
  EXPECT_EQ(*case_of(result, result.findings.front()).bytes, *made[worst].bytes);
}

TEST_F(HuntSearches, ABaseOfWhichNothingBeginsIsNamed) {
  const Hunt hunt = read(twenty + "generate: [{family: corridor, options: [{key: epsilon_m, values: [0.3]}]}]\n");
  const HuntResult result = run(hunt, ended("complete"));
  const std::string text = hunt_text(hunt, result, "out");
  EXPECT_NE(text.find("no draw of corridor made a run; the first: "), std::string::npos) << text;
  EXPECT_EQ(text.find("no draw of quickstart"), std::string::npos) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
