// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/hunt/hunt.h"
#include "scenarios/hunt/hunt_case.h"
#include "scenarios/hunt/hunt_schema.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/schema_example.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

/// Hunt files beside a copy of the library.
class HuntFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "library");
    fs::create_directory(folder_ / "work");
    for (const char* name : {"quickstart.yaml", "quickstart.plan.yaml"})
      fs::copy_file(project_file("scenarios/library/") + name, folder_ / "library/" + name);
  }

  [[nodiscard]] Hunt read(const std::string& text) const {
    std::ofstream(folder_ / "hunt.yaml") << text;
    return read_hunt(folder_ / "hunt.yaml");
  }
  /// Of the file, or of the scenarios that it makes.
  [[nodiscard]] std::string error_of(const std::string& text) const {
    return input_error([&] {
      const Hunt hunt = read(text);
      const HuntCases cases(hunt, folder_ / "work", slam::methods());
    });
  }

  Folder folder_;
};

const std::string start = "hunt: 1\nscenarios: [library/quickstart.yaml]\n";

TEST_F(HuntFiles, ExamplesAreValidAndHaveEveryKey) {
  std::vector<Tree> trees;
  for (const std::string& text : hunt_examples()) {
    EXPECT_EQ(error_of(text), "no error");
    trees.push_back(read_yaml(text, "example.yaml"));
  }
  for (const SchemaSection& section : hunt_schema()) {
    if (section.name == "options" || section.name == "gates") continue;  // as vary, and as in a scenario
    for (const SchemaField& field : section.fields)
      EXPECT_FALSE(example_of(trees, section, field).empty()) << section.name << " " << field.key;
  }
}

TEST_F(HuntFiles, WhatIsWrongIsRefusedWhereItStands) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_NE(error.find("hunt.yaml:"), std::string::npos) << error;
  };
  expect("sweep: 1\n", "the first key of a hunt must be 'hunt: 1'");
  expect("hunt: 1\n", "names nothing to hunt in");
  expect(start + "run: 3\n", "unknown key 'run'");
  expect(start + "runs: 0\n", "runs");
  expect("hunt: 1\nscenarios: [nowhere.yaml]\n", "does not exist");
  expect(start + "vary: [{key: lidar.rpm}]\n", "needs either values, or min and max");
  expect(start + "vary: [{key: lidar.rpm, min: 300}]\n", "needs either values, or min and max");
  expect(start + "vary: [{key: lidar.rpm, min: 300, max: 600, values: [300]}]\n", "needs either values");
  expect(start + "vary: [{key: lidar.rpm, min: 600, max: 300}]\n", "min must not be greater than max");
  expect(start + "vary: [{key: faults.slip_mps, min: 0, max: 1, log: true}]\n", "min must be more than 0");
  expect(start + "vary: [{key: speed_mps, values: [0.5]}, {key: speed_mps, values: [0.6]}]\n", "in the list already");
  expect(start + "vary: [{key: prior.jaw, values: [known]}]\n", "did you mean 'yaw'?");
  expect(start + "vary: [{key: speed_mps, min: 0.5, max: 50}]\n", "speed_mps");
  expect(start + "vary: [{key: prior.yaw, values: [known, unknwon, unknown]}]\n", "did you mean 'unknown'?");
  expect(start + "vary: [{key: seed, min: 1, max: 2}]\n", "a hunt gives every run its seed");
  expect(start + "vary: [{key: building, values: [a.ifc]}]\n", "a hunt's runs are in their scenario's building");
  expect(start + "methods: [vgicp]\nvary: [{key: methods, values: ['[odometry]']}]\n",
         "the hunt sets 'methods' itself");
  expect(start + "vary: [{key: route.loop, min: 1.2, max: 1.8, whole: true}]\n", "no whole number lies between");
  expect(start + "methods: [vgipc]\n", "did you mean 'vgicp'?");
  expect(start + "gates: [{metric: ate, method: vgicp, max: 1}]\n", "unknown metric 'ate'");
  const std::string gate = "gates: [{metric: ate_aligned_rmse_m, method: ";
  expect(start + "methods: [vgicp]\n" + gate + "vgicpp, max: 1}]\n", "hunt.yaml:4:9: unknown method 'vgicpp'");
  expect(start + "methods: [vgicp]\n" + gate + "odometry, max: 1}]\n", "'odometry' is not one of the methods");
  const std::string corridor = "hunt: 1\ngenerate: [{family: corridor, options: [{key: ";
  expect(corridor + "epsilon_m, min: 0.15, max: 0.6}]}]\n", "hunt.yaml:2:41: 'epsilon_m': 0.6 is out of range");
  expect(corridor + "rooms, min: 1, max: 4}]}]\n", "out of range");
  expect(corridor + "rooms, min: 3.2, max: 3.8}]}]\n", "no whole number lies between");
  expect(corridor + "feature, values: [column, pillar]}]}]\n", "pillar");
  expect("hunt: 1\ngenerate: [{family: coridor}]\n", "did you mean 'corridor'?");
  expect("hunt: 1\ngenerate: [{family: corridor, options: [{key: room, min: 3, max: 4}]}]\n", "did you mean 'rooms'?");
}

TEST_F(HuntFiles, ARunHasWhatWasDrawnAndItsSeed) {
  const Hunt hunt = read(start +
                         "generate: [{family: corridor, options: [{key: rooms, min: 3, max: 8}]}]\n"
                         "methods: [vgicp]\nvary: [{key: faults.slip_mps, min: 0.1, max: 0.3}]\n"
                         "gates: [{metric: ate_aligned_rmse_m, method: vgicp, max: 0.2}]\n");
  const HuntCases cases(hunt, folder_ / "work", slam::methods());
  HuntRun varied{0, {0.5}, 77, std::nullopt};
  cases.make(varied);
  ASSERT_TRUE(varied.run) << varied.why;
  const Scenario scenario = read_scenario(write_yaml(varied.run->scenario), "a.yaml").scenario;
  EXPECT_EQ(scenario.faults->slip_mps, 0.2);
  EXPECT_EQ(scenario.seed, 77U);
  EXPECT_EQ(scenario.building, "building.plan.yaml");
  EXPECT_EQ(scenario.methods, std::vector<std::string>{"vgicp"});
  ASSERT_EQ(scenario.gates.size(), 1U);

  HuntRun corridor{1, {0.999, 0.5}, 78, std::nullopt};
  cases.make(corridor);
  ASSERT_TRUE(corridor.run) << corridor.why;
  EXPECT_EQ(corridor.values.front(), (std::pair<std::string, std::string>("corridor rooms", "8")));
  HuntRun other = corridor;
  other.seed = 79;
  cases.make(other);
  EXPECT_NE(*other.run->bytes, *corridor.run->bytes);  // sizes are drawn from the run's seed
}

TEST_F(HuntFiles, SizesThatNoBuildingHasMakeNoRunAndSayWhy) {
  const Hunt hunt = read(
      "hunt: 1\nmethods: [vgicp]\n"
      "generate: [{family: corridor, options: [{key: epsilon_m, min: 0.001, max: 0.3}, {key: feature, values: "
      "[column]}]}]\n");
  const HuntCases cases(hunt, folder_ / "work", slam::methods());
  HuntRun run{0, {0.0, 0.5}, 1, std::nullopt};
  cases.make(run);
  EXPECT_FALSE(run.run);
  EXPECT_NE(run.why, "");
  EXPECT_EQ(run.why.find(folder_.path() + "/work"), std::string::npos) << run.why;
}

}  // namespace
}  // namespace plumbline::scenarios
