// SPDX-License-Identifier: Apache-2.0
// `plumbline compare` on sweeps and runs that the program made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "bim/config/tree.h"
#include "tests/system/program.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

/// Walks of two seconds with poor and with good leg odometry: a sweep and a run of each.
class CompareSweeps : public RunOnce<CompareSweeps> {
 public:
  static Outcome begin() {
    write_file(*folder_ / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
    Outcome outcome;
    for (const auto& [name, preset] : {std::pair("poor", "noisy"), std::pair("good", "ideal")}) {
      fs::create_directory(*folder_ / ("of " + std::string(name)));
      const std::string of = *folder_ / ("of " + std::string(name)) + "/";
      write_file(of + "s.yaml",
                 "scenario: 1\nname: s\nbuilding: ../short.plan.yaml\nstart: {room: left}\nroute: {rooms: [hall]}\n"
                 "duration_s: 2\nmethods: [odometry]\nodometry: {preset: " +
                     std::string(preset) + "}\n");
      write_file(of + "sweep.yaml", "sweep: 1\nscenarios: [s.yaml]\nseeds: 7\n");
      outcome = plumbline({"sweep", of + "sweep.yaml", "-o", *folder_ / name});
      if (outcome.code != 0) return outcome;
      outcome = plumbline({"run", of + "s.yaml", "--out", *folder_ / ("run " + std::string(name))});
      if (outcome.code != 0) return outcome;
    }
    return outcome;
  }

 protected:
  static Outcome compare(const std::string& a, const std::string& b, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"compare", a, b};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Setting setting;
    setting.cwd = folder_->path();
    return plumbline(arguments, setting);
  }
  static std::string last_line(const std::string& text) { return text.substr(text.rfind('\n', text.size() - 2) + 1); }
  /// One line on stderr that holds these words, nothing on stdout, exit code 2.
  static void expect_refused(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
};

TEST_F(CompareSweeps, WorseIsExitCodeOne) {
  const Outcome worse = compare("good", "poor");
  EXPECT_EQ(worse.code, 1) << worse.out << worse.err;
  EXPECT_EQ(last_line(worse.out).rfind("verdict: worse in odometry ate_aligned_rmse_m", 0), 0U) << worse.out;
  EXPECT_NE(worse.out.find("sensor data: not the same in 7 of 7 pairs"), std::string::npos) << worse.out;
  EXPECT_EQ(compare("good", "poor").out, worse.out);
  EXPECT_EQ(compare("good", "poor", {"--fail-on", "never"}).code, 0);

  const Outcome better = compare("poor", "good");
  EXPECT_EQ(better.code, 0) << better.err;
  EXPECT_EQ(last_line(better.out).rfind("verdict: better in odometry ate_aligned_rmse_m", 0), 0U) << better.out;
  EXPECT_EQ(compare("poor", "good", {"--fail-on", "different"}).code, 1);
}

TEST_F(CompareSweeps, ItselfIsTheSame) {
  for (const char* name : {"poor", "run poor"}) {
    const Outcome outcome = compare(name, name, {"--fail-on", "different"});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(last_line(outcome.out), "verdict: same, byte for byte\n");
  }
}

TEST_F(CompareSweeps, TwoRunsShowTheirValues) {
  const Outcome outcome = compare("run poor", "run good", {"--metric", "ate_rmse_m,map_rmse_m"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(last_line(outcome.out), "verdict: differs; a single pair shows no more\n");
  EXPECT_EQ(outcome.out.find(" p "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("ate_aligned_rmse_m"), std::string::npos) << outcome.out;
  EXPECT_EQ(compare("run poor", "run good", {"--fail-on", "different"}).code, 1);
}

TEST_F(CompareSweeps, JsonHoldsTheSame) {
  const Outcome outcome = compare("good", "poor", {"--json"});
  EXPECT_EQ(outcome.code, 1);
  const Tree tree = read_json(outcome.out, "stdout");
  EXPECT_EQ(tree.find("a")->as_string(), "good");
  EXPECT_EQ(tree.find("verdict")->as_string(), "worse");
  EXPECT_EQ(tree.find("methods")->find("odometry")->find("pairs")->as_int(), 7);
  EXPECT_EQ(outcome.out.find(folder_->path()), std::string::npos);
}

TEST_F(CompareSweeps, MissingSeedsAreNamed) {
  ASSERT_EQ(plumbline({"sweep", *folder_ / "of poor/sweep.yaml", "-o", *folder_ / "fewer", "--seeds", "2"}).code, 0);
  const Outcome outcome = compare("poor", "fewer");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("odometry, 2 pairs: same, byte for byte"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("only in A: 5: s, seed 3, odometry; "), std::string::npos) << outcome.out;
  EXPECT_EQ(compare("poor", "fewer", {"--fail-on", "different"}).code, 1);
  // Tables of fewer seeds than there are results: as after a stop, or on purpose.
  ASSERT_EQ(plumbline({"sweep", *folder_ / "of poor/sweep.yaml", "-o", *folder_ / "fewer", "--seeds", "1"}).code, 0);
  const Outcome shrunk = compare("poor", "fewer");
  EXPECT_EQ(shrunk.code, 0);
  EXPECT_NE(shrunk.err.find("fewer: results/ holds 2 runs, runs.csv 1"), std::string::npos) << shrunk.err;
}

TEST_F(CompareSweeps, AnAlteredRunIsTold) {
  fs::copy(*folder_ / "run poor", *folder_ / "altered", fs::copy_options::recursive);
  std::string results = read_file(*folder_ / "altered/results.json");
  results.replace(results.find("\"complete\""), 10, "\"crashed\"");
  write_file(*folder_ / "altered/results.json", results);
  const Outcome outcome = compare("run poor", "altered");
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_NE(outcome.err.find("altered: results.json was altered"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("scores: other in 1 pair with equal digests"), std::string::npos) << outcome.out;
  EXPECT_TRUE(last_line(outcome.out).ends_with("; failures only in B: 1\n")) << outcome.out;
}

/// A program of another name that does what ours does.
std::string wrapper(const Folder& folder, const std::string& name, const std::string& command) {
  write_file(folder / name, "#!/bin/sh\n" + command + "\n");
  fs::permissions(folder / name, fs::perms::owner_all);
  return "./" + name;
}

TEST_F(CompareSweeps, TwoProgramsRunTheSweepAndAreCompared) {
  const std::string ours = "exec '" + std::string(std::getenv("PLUMBLINE_BINARY")) + "' ";
  const std::string before = wrapper(*folder_, "before", ours + "\"$@\"");
  // The second one runs the sweep of the poor odometry whatever it is asked for.
  const std::string after = wrapper(*folder_, "after", ours + "sweep 'of poor/sweep.yaml' -o \"$4\"");
  const std::vector<std::string> on = {"--on", "of good/sweep.yaml", "-o", "change"};
  const Outcome same = compare(before, before, {"--on", "of good/sweep.yaml", "-o", "none", "--seeds", "1"});
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(last_line(same.out), "verdict: same, byte for byte\n");
  const Outcome worse = compare(before, after, on);
  EXPECT_EQ(worse.code, 1) << worse.err;
  EXPECT_EQ(worse.out.rfind("A: ./before\nB: ./after\n", 0), 0U) << worse.out;
  const auto made = fs::last_write_time(*folder_ / "change/b/results/s-1.json");
  EXPECT_EQ(compare(before, after, on).out, worse.out);
  EXPECT_EQ(fs::last_write_time(*folder_ / "change/b/results/s-1.json"), made);

  (void)wrapper(*folder_, "after", ours + "sweep 'of poor/sweep.yaml' -o \"$4\" # built anew");
  expect_refused(compare(before, after, on), "change/b: is of another program; name another -o, or remove change");
  expect_refused(compare(before, after), "./before: is a program; name by --on the sweep that both are to run");
  expect_refused(compare(before, after, {"--on", "of good/sweep.yaml"}), "--on: needs -o");
  expect_refused(compare("poor", "good", on), "poor: is no program");
  expect_refused(compare("poor", "good", {"-o", "other"}), "--out requires --on");
  const Outcome missing = compare(before, after, {"--on", "missing.yaml", "-o", "in/other"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("./before: refuses the sweep: missing.yaml: "), std::string::npos) << missing.err;
  const Outcome no_sweep = compare("/bin/true", after, {"--on", "of good/sweep.yaml", "-o", "in/other"});
  EXPECT_EQ(no_sweep.code, 2);
  EXPECT_NE(no_sweep.err.find("/bin/true: made no sweep"), std::string::npos) << no_sweep.err;
  EXPECT_FALSE(fs::exists(*folder_ / "in"));
}

TEST_F(CompareSweeps, RefusesWhatItCannotCompare) {
  expect_refused(compare("poor", "run poor"), "run poor: is a run and poor a sweep; name two of one kind");
  expect_refused(compare("poor", "nothing"), "nothing: is not there; name a run directory (results.json) or");
  expect_refused(compare("poor/runs.csv", "poor"), "poor/runs.csv: is a file; name a run directory");
  expect_refused(compare("of poor", "poor"), "of poor: holds neither a run nor a sweep; name a run directory");
  expect_refused(compare("poor", "good", {"--metric", "ate_rmse"}), "did you mean 'ate_rmse_m'?");
  expect_refused(compare("poor", "good", {"--metric", "rooms.found"}), "is better neither lower nor higher");
  expect_refused(compare("poor", "good", {"--metric", "rooms.recall"}), "no run of a pair has 'rooms.recall'");
  expect_refused(compare("poor", "good", {"--fail-on", "sometimes"}), "--fail-on");

  ASSERT_EQ(plumbline({"sweep", *folder_ / "of poor/sweep.yaml", "--shard", "1/2", "-o", *folder_ / "part"}).code, 0);
  expect_refused(compare("poor", "part"), "part: holds an unfinished sweep; run the sweep's command again");
  ASSERT_EQ(plumbline({"run", *folder_ / "of poor/s.yaml", "--seed", "2", "--out", *folder_ / "seed 2"}).code, 0);
  expect_refused(compare("run poor", "seed 2"), "the first there is s, seed 1, odometry, and here s, seed 2, odometry");
}

}  // namespace
}  // namespace plumbline::system_tests
