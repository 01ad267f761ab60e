// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "scenarios/sweep/sweep_schema.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

/// Sweep files beside a copy of the library.
class SweepFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "library");
    for (const char* name : {"quickstart.yaml", "quickstart.plan.yaml", "house.yaml", "house.plan.yaml"})
      fs::copy_file(project_file("scenarios/library/") + name, folder_ / "library/" + name);
  }

  [[nodiscard]] Sweep read(const std::string& text, int seeds = 0) const {
    std::ofstream(folder_ / "sweep.yaml") << text;
    return read_sweep(folder_ / "sweep.yaml", seeds);
  }
  [[nodiscard]] std::string error_of(const std::string& text) const {
    return input_error([&] { (void)read(text); });
  }

  Folder folder_;
};

TEST_F(SweepFiles, ExamplesGiveEveryCombinationOnce) {
  const Sweep first = read(sweep_examples()[0]);
  EXPECT_EQ(first.runs.size(), 2U * 2U * 20U);
  std::set<std::string> keys, digests;
  for (const SweepRun& run : first.runs) {
    keys.insert(run.key);
    digests.insert(run.input_digest);
  }
  EXPECT_EQ(keys.size(), first.runs.size());
  EXPECT_EQ(digests.size(), first.runs.size());
  EXPECT_EQ(read(sweep_examples()[1]).runs.size(), 3U * 5U);
}

TEST_F(SweepFiles, AreReadFromTheCurrentFolder) {
  fs::copy(folder_ / "library", folder_ / "here");
  std::ofstream(folder_ / "here/sweep.yaml") << "sweep: 1\nscenarios: [quickstart.yaml]\nseeds: 1\n";
  const Sweep whole = read_sweep(folder_ / "here/sweep.yaml", 0);
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "here");
  std::optional<Sweep> named;
  EXPECT_NO_THROW(named = read_sweep("sweep.yaml", 0));
  fs::current_path(before);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->scenario_texts, whole.scenario_texts);
}

TEST_F(SweepFiles, ProcessesOfTheSweepAndOfItsScenariosAreMethods) {
  std::ofstream(folder_ / "library/own.yaml")
      << "scenario: 1\nbuilding: house.plan.yaml\nmethods: [{name: theirs, command: [./b]}]\n";
  const Sweep sweep = read(
      "sweep: 1\nscenarios: [library/own.yaml]\nseeds: 1\nsensors: [all, lidar]\n"
      "methods: [vgicp, theirs, {name: mine, command: [./a], folder: slam}]\n");
  ASSERT_EQ(sweep.scenario_texts.size(), 1U);
  const Scenario scenario = read_scenario(sweep.scenario_texts[0], "made").scenario;
  EXPECT_EQ(scenario.methods,
            (std::vector<std::string>{"vgicp", "vgicp.lidar", "theirs", "theirs.lidar", "mine", "mine.lidar"}));
  ASSERT_EQ(scenario.processes.size(), 2U);
  EXPECT_EQ(scenario.processes[0].folder, folder_ / "library");
  EXPECT_EQ(scenario.processes[1].folder, folder_ / "slam");
}

TEST_F(SweepFiles, AChangedProgramIsAnotherInput) {
  const auto digest_with = [&](const std::string& program) {
    std::ofstream(folder_ / "mine.py") << program;
    return read(
               "sweep: 1\nscenarios: [library/house.yaml]\nseeds: 1\n"
               "methods: [{name: mine, command: [python3, mine.py, --fast]}]\n")
        .runs.at(0)
        .input_digest;
  };
  const std::string first = digest_with("a = 1\n");
  EXPECT_EQ(digest_with("a = 1\n"), first);
  EXPECT_NE(digest_with("a = 2\n"), first);
}

// What a script imports stands beside it; what programs write there is no part of it.
TEST_F(SweepFiles, AChangedFileBesideAScriptIsAnotherInput) {
  fs::create_directories(folder_ / "hp/part");
  std::ofstream(folder_ / "hp/main.py") << "import helper\n";
  const auto digest = [&] {
    return read(
               "sweep: 1\nscenarios: [library/house.yaml]\nseeds: 1\n"
               "methods: [{name: mine, command: [/usr/bin/env, hp/main.py]}]\n")
        .runs.at(0)
        .input_digest;
  };
  const auto write = [&](const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  };
  std::string before = digest();
  EXPECT_EQ(digest(), before);
  for (const std::string name : {"hp/helper.py", "hp/part/inner.py"})
    for (const std::string text : {"", "X = 0\n", "X = 1\n"}) {
      write(name, text);
      const std::string now = digest();
      EXPECT_NE(now, before) << name << " " << text;
      before = now;
    }
  for (const std::string name :
       {"hp/__pycache__/helper.pyc", "hp/.git/index", "hp/mine.log", "hp/out/results/a.json", "hp/out/table.csv",
        "hp/run/manifest.csv", "hp/run/results.json", "hp/out.shards/array.sh", "beside.py", "hp/other.yaml"}) {
    write(name, name.ends_with(".yaml") ? "# more seeds\nsweep: 1\n" : "1\n");
    EXPECT_EQ(digest(), before) << name;
  }
}

TEST_F(SweepFiles, TheFolderOfAScriptIsWatchedUpToABound) {
  std::ofstream(folder_ / "main.py") << "1\n";
  for (int i = 0; i < 1000; ++i) std::ofstream(folder_ / ("n" + std::to_string(i))) << i;
  const Sweep sweep = read(
      "sweep: 1\nscenarios: [library/house.yaml]\nseeds: 1\n"
      "methods: [{name: mine, command: [python3, main.py]}]\n");
  ASSERT_EQ(sweep.notes.size(), 1U);
  EXPECT_NE(sweep.notes.front().find("only its first 1000 files and 64 MB are watched"), std::string::npos);
}

TEST_F(SweepFiles, AProcessThatAScenarioDoesNotHaveIsRefused) {
  EXPECT_NE(error_of("sweep: 1\nscenarios: [library/house.yaml]\nmethods: [theirs]\n")
                .find("sweep.yaml:3:11: unknown method 'theirs'"),
            std::string::npos);
  EXPECT_NE(error_of("sweep: 1\nscenarios: [library/house.yaml]\nmethods: ['mine=./a b']\n")
                .find("sweep.yaml:3:11: 'mine=./a b' is no name; a process is {name: NAME, command:"),
            std::string::npos);
  EXPECT_NE(error_of("sweep: 1\nscenarios: [library/house.yaml]\nmethods: [{name: vgicp, command: [./a]}]\n")
                .find("'vgicp' is in the table already"),
            std::string::npos);
}

TEST_F(SweepFiles, FewerSeedsAreTheFirstOfMore) {
  const Sweep all = read(sweep_examples()[0]);
  const Sweep some = read(sweep_examples()[0], 7);
  EXPECT_EQ(some.runs.size(), 2U * 2U * 7U);
  std::set<std::string> digests;
  for (const SweepRun& run : all.runs) digests.insert(run.input_digest);
  for (const SweepRun& run : some.runs) {
    EXPECT_LE(run.seed, 7U);
    EXPECT_TRUE(digests.contains(run.input_digest)) << run.key;
  }
}

TEST_F(SweepFiles, OnlyWhatMethodsAreToldSharesAWalk) {
  const Sweep sweep = read(
      "sweep: 1\nscenarios: [library/quickstart.yaml, library/house.yaml]\nseeds: 2\nvariants:\n"
      "  - {name: told, set: [prior.yaw=known]}\n"
      "  - {name: other, set: [prior.yaw=unknown, 'methods=[odometry]', 'gates=[]']}\n"
      "  - {name: slow, set: [prior.yaw=known, speed_mps=0.5]}\n");
  ASSERT_EQ(sweep.runs.size(), 12U);
  std::set<std::string> walks;
  for (const SweepRun& a : sweep.runs) {
    walks.insert(a.simulation_digest);
    for (const SweepRun& b : sweep.runs) {
      const bool alike = a.scenario == b.scenario && a.seed == b.seed && (a.variant == "slow") == (b.variant == "slow");
      EXPECT_EQ(a.simulation_digest == b.simulation_digest, alike) << a.key << " " << b.key;
    }
  }
  EXPECT_EQ(walks.size(), 8U);
}

TEST_F(SweepFiles, AVariantReplacesValues) {
  const Sweep sweep = read(
      "sweep: 1\nscenarios: [library/quickstart.yaml]\nseeds: 1\nvariants: [{name: x, set: [prior.yaw=unknown, "
      "speed_mps=0.5]}]\nstarts: [{random: rooms}]\n");
  const Scenario scenario = read_scenario(sweep.scenario_texts.at(sweep.runs.at(0).text), "made").scenario;
  EXPECT_EQ(scenario.prior.yaw, Knowledge::unknown);
  EXPECT_EQ(scenario.prior.storey, Knowledge::known);
  EXPECT_EQ(scenario.speed_mps, 0.5);
  EXPECT_EQ(scenario.start.random, RandomStart::rooms);
  EXPECT_FALSE(scenario.start.room.has_value());
}

TEST_F(SweepFiles, SensorsAreOfTheSweepOrOfAVariantAndShareAWalk) {
  const auto methods_of = [](const Sweep& sweep, std::size_t run) {
    return read_scenario(sweep.scenario_texts.at(sweep.runs.at(run).text), "made").scenario.methods;
  };
  const std::string head =
      "sweep: 1\nscenarios: [library/quickstart.yaml]\nseeds: 1\nmethods: [truth, odometry, vgicp]\n";
  const Sweep both = read(head + "sensors: [all, lidar]\n");
  EXPECT_EQ(methods_of(both, 0), (std::vector<std::string>{"truth", "odometry", "vgicp", "vgicp.lidar"}));
  const Sweep each = read(
      "sweep: 1\nscenarios: [library/quickstart.yaml]\nseeds: 1\nmethods: [vgicp]\nvariants:\n"
      "  - {name: all, set: [sensors=all]}\n  - {name: lidar, set: [sensors=lidar]}\n");
  ASSERT_EQ(each.runs.size(), 2U);
  EXPECT_EQ(methods_of(each, 0), std::vector<std::string>{"vgicp"});
  EXPECT_EQ(methods_of(each, 1), std::vector<std::string>{"vgicp.lidar"});
  EXPECT_EQ(each.runs[0].simulation_digest, each.runs[1].simulation_digest);
  EXPECT_NE(each.runs[0].input_digest, each.runs[1].input_digest);
  EXPECT_NE(
      error_of(head + "sensors: [lidar]\nvariants: [{name: a, set: [sensors=all]}]\n").find("set it in one place"),
      std::string::npos);
  EXPECT_NE(
      error_of("sweep: 1\nscenarios: [library/quickstart.yaml]\nmethods: [odometry.lidar]\n").find("sweep.yaml:3:11"),
      std::string::npos);
}

TEST_F(SweepFiles, NoTwoRunsHaveOneName) {
  namespace fs = std::filesystem;
  fs::copy_file(folder_ / "library/house.yaml", folder_ / "library/a.yaml");
  fs::copy_file(folder_ / "library/house.yaml", folder_ / "library/a-b.yaml");
  const std::string files = "sweep: 1\nscenarios: [library/a.yaml, library/a-b.yaml]\nseeds: 1\n";
  EXPECT_EQ(error_of(files + "variants: [{name: c}, {name: d}]\n"), "no error");
  EXPECT_NE(error_of(files + "variants: [{name: c}, {name: b-c}]\n").find("both called 'a-b-c'"), std::string::npos);
}

TEST_F(SweepFiles, FaultsAreNamedWhereTheyStand) {
  const std::string head = "sweep: 1\nscenarios: [library/quickstart.yaml]\n";
  EXPECT_NE(error_of("scenarios: [a]\n").find("sweep.yaml:1:1"), std::string::npos);
  EXPECT_NE(error_of("sweep: 1\n").find("scenarios"), std::string::npos);
  EXPECT_NE(error_of("sweep: 1\nscenarios: [library/none.yaml]\n").find("sweep.yaml:2:13"), std::string::npos);
  EXPECT_NE(error_of("sweep: 1\nscenarios: [library/house.plan.yaml]\n").find("no scenario"), std::string::npos);
  EXPECT_NE(error_of(head + "methods: [vgcip]\n").find("sweep.yaml:3:11"), std::string::npos);
  EXPECT_NE(error_of(head + "seeds: 0\n").find("sweep.yaml:3:8"), std::string::npos);
  EXPECT_NE(error_of(head + "variants: [{name: a, set: [speed_mps]}]\n").find("key.key=value"), std::string::npos);
  EXPECT_NE(error_of(head + "variants: [{name: a, set: [sped_mps=1]}]\n").find("did you mean"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "a.";
  EXPECT_NE(error_of(head + "variants: [{name: a, set: [" + deep + "a=1]}]\n").find("of more than 16 parts"),
            std::string::npos);
  EXPECT_NE(error_of(head + "variants: [{name: a}, {name: a}]\n").find("in the list already"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
