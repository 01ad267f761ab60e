// SPDX-License-Identifier: Apache-2.0
// A hunt for slips at which leg odometry fails and LiDAR odometry does not.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "bim/config/tree.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

std::string hunt_file(const std::string& more) {
  return "hunt: 1\nname: slips\nscenarios: [walk.yaml]\nruns: 4\nmethods: [odometry, vgicp]\n"
         "vary: [{key: faults.slip_mps, min: 0.01, max: 2, log: true}]\n" +
         more;
}

class HuntSlips : public RunOnce<HuntSlips, 1> {
 public:
  static Outcome begin() {
    write_file(*folder_ / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
    write_file(*folder_ / "walk.yaml",
               "scenario: 1\nname: walk\nbuilding: short.plan.yaml\nstart: {room: left}\n"
               "route: {rooms: [hall, right]}\nduration_s: 4\n");
    write_file(*folder_ / "hunt.yaml",
               hunt_file("gates: [{metric: ate_aligned_rmse_m, method: odometry, max: 0.012}]\n"));
    return hunt("hunt.yaml", *folder_ / "found", {"--jobs", "2"});
  }
  [[nodiscard]] static Outcome hunt(const std::string& file, const std::string& out,
                                    std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"hunt", *folder_ / file, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return plumbline(arguments);
  }
};

TEST_F(HuntSlips, FindsWhatIsTheMethodsFaultAndHowToRepeatIt) {
  EXPECT_NE(outcome_->out.find("1  odometry: complete, ate_aligned_rmse_m <= 0.012; in "), std::string::npos)
      << outcome_->out;
  EXPECT_NE(outcome_->out.find("4 runs, 1 kinds of failure"), std::string::npos) << outcome_->out;
  const std::string csv = read_file(*folder_ / "found/hunt.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 2);
  EXPECT_NE(csv.find(",yes,vgicp kept the same bound,"), std::string::npos) << csv;
  EXPECT_FALSE(fs::exists(*folder_ / "found/.partial"));
  const Outcome again = plumbline({"run", *folder_ / "found/failures/01/scenario.yaml", "-o", *folder_ / "again"});
  EXPECT_EQ(again.code, 1) << again.err;
}

TEST_F(HuntSlips, DoesNotDependOnJobsAndCanGoWithoutFailing) {
  const Outcome one = hunt("hunt.yaml", *folder_ / "one", {"--jobs", "1", "--fail-on", "never"});
  EXPECT_EQ(one.code, 0) << one.err;
  for (const char* file : {"hunt.csv", "hunt.json", "failures/01/scenario.yaml", "failures/01/building.plan.yaml"})
    EXPECT_TRUE(read_file(*folder_ / "found/" + std::string(file)) == read_file(*folder_ / "one/" + std::string(file)))
        << file;
}

TEST_F(HuntSlips, ShrinksWhatItFindsWhenAsked) {
  const Outcome shrunk = hunt("hunt.yaml", *folder_ / "shrunk", {"--shrink", "1", "--shrink-runs", "3"});
  EXPECT_EQ(shrunk.code, 1) << shrunk.err;
  const std::string first = *folder_ / "shrunk/failures/01/";
  const Tree run = read_json(read_file(first + "run/results.json"), "results.json");
  EXPECT_EQ(run.find("methods")->as_map().size(), 2U);
  const Tree json = read_json(read_file(first + "small/shrink.json"), "shrink.json");
  EXPECT_EQ(json.find("failure")->find("method")->as_string(), "odometry");
  EXPECT_EQ(json.find("runs")->as_int(), 3);
  EXPECT_EQ(json.find("after")->find("methods")->as_int(), 1);
  EXPECT_EQ(plumbline({"hunt", *folder_ / "hunt.yaml", "-o", *folder_ / "none", "--shrink-runs", "3"}).code, 2);
}

TEST_F(HuntSlips, AFindingThatCannotBeShrunkIsNotedAndTheHuntStays) {
  const fs::path tests = fs::path(std::getenv("PLUMBLINE_BINARY")).parent_path() / "tests";
  write_file(*folder_ / "once.sh", "test -e '" + (*folder_ / "was_run") + "' && exec " +
                                       (tests / "process_vgicp").string() + "\ntouch '" + (*folder_ / "was_run") +
                                       "'\nexit 1\n");
  write_file(*folder_ / "once.yaml", read_file(*folder_ / "walk.yaml") + "processes: [{name: once, command: [sh, " +
                                         (*folder_ / "once.sh") + "]}]\n");
  write_file(*folder_ / "crash.yaml", "hunt: 1\nscenarios: [once.yaml]\nruns: 1\nmethods: [once]\n");
  const Outcome crashed = hunt("crash.yaml", *folder_ / "crashed", {"--shrink", "1"});
  EXPECT_EQ(crashed.code, 1) << crashed.err;
  EXPECT_NE(crashed.err.find("warning: failures/01 is not shrunk: plumbline shrink ended with 2"), std::string::npos)
      << crashed.err;
  EXPECT_TRUE(fs::exists(*folder_ / "crashed/hunt.csv"));
  EXPECT_TRUE(fs::exists(*folder_ / "crashed/failures/01/scenario.yaml"));
}

TEST_F(HuntSlips, WhereEveryWalkFailsTheTablesSayWhy) {
  write_file(*folder_ / "pushed.yaml", read_file(*folder_ / "walk.yaml") + "pushes: {max_n: 1000, every_s: 1}\n");
  write_file(*folder_ / "falls.yaml", "hunt: 1\nscenarios: [pushed.yaml]\nruns: 1\nmethods: [odometry]\n");
  const Outcome falls = hunt("falls.yaml", *folder_ / "falls");
  EXPECT_EQ(falls.code, 4) << falls.err;
  EXPECT_NE(read_file(*folder_ / "falls/hunt.csv").find("the robot fell"), std::string::npos);
}

TEST_F(HuntSlips, ABoundThatNobodyKeepsIsNobodysFault) {
  write_file(*folder_ / "strict.yaml",
             hunt_file("gates: [{metric: ate_aligned_rmse_m, method: odometry, max: 1e-9}]\n"));
  const Outcome strict = hunt("strict.yaml", *folder_ / "strict", {"--max-runs", "2"});
  EXPECT_EQ(strict.code, 0) << strict.err;
  EXPECT_NE(strict.out.find("not the method's fault: 2 failures\n  2  no other method of the run did better"),
            std::string::npos)
      << strict.out;
  EXPECT_FALSE(fs::exists(*folder_ / "strict/failures"));
}

/// Interrupts the hunt while the first run of its first or second generation is made.
Outcome interrupted(const std::string& file, const std::string& out, bool second) {
  Setting setting;
  setting.signal = SIGTERM;
  std::string first;
  setting.kill_when = [&, first]() mutable {
    const std::string tried = read_file(out + "/.partial/work/trial0/scenario.yaml");
    if (first.empty()) first = tried;
    return !tried.empty() && (!second || tried != first);
  };
  return plumbline({"hunt", file, "-o", out, "--jobs", "1"}, setting);
}

TEST_F(HuntSlips, InterruptedItKeepsTheGenerationsThatAreDone) {
  const std::string nothing = *folder_ / "stopped_at_once", out = *folder_ / "stopped";
  EXPECT_EQ(interrupted(*folder_ / "hunt.yaml", nothing, false).code, 128 + SIGTERM);
  EXPECT_FALSE(fs::exists(nothing));
  const Outcome stopped = interrupted(*folder_ / "hunt.yaml", out, true);
  EXPECT_EQ(stopped.code, 128 + SIGTERM) << stopped.err;
  EXPECT_NE(stopped.err.find("holds the first 2 runs"), std::string::npos) << stopped.err;
  const std::string csv = read_file(out + "/hunt.csv"), whole = read_file(*folder_ / "found/hunt.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 2);
  EXPECT_TRUE(whole.starts_with(csv));
  EXPECT_FALSE(fs::exists(out + "/.partial"));
}

TEST_F(HuntSlips, CarelessUseIsRefusedAndLeavesNothing) {
  const std::string out = *folder_ / "none";
  const auto error = [&](const std::string& text, std::vector<std::string> more = {}) {
    write_file(*folder_ / "wrong.yaml", text);
    const Outcome outcome = hunt("wrong.yaml", out, std::move(more));
    EXPECT_EQ(outcome.code, 2) << text << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(out)) << text;
    return outcome.err;
  };
  EXPECT_NE(error(hunt_file("gate: []\n")).find("wrong.yaml:7:"), std::string::npos);
  EXPECT_NE(error("hunt: 1\nscenarios: [walk.yaml]\nvary: [{key: fautls.slip_mps, min: 0, max: 1}]\n")
                .find("did you mean 'faults'?"),
            std::string::npos);
  EXPECT_NE(error("hunt: 1\nscenarios: [walk.yaml]\nmethods: [odometri]\n").find("did you mean 'odometry'?"),
            std::string::npos);
  EXPECT_NE(error("hunt: 1\nscenarios: [walk.yaml]\nmethods: [odometry]\n"
                  "runs: 2\nvary: [{key: start, values: ['{room: attic}']}]\n")
                .find("no run can be made; the first: "),
            std::string::npos);
  (void)error(hunt_file(""), {"--fail-on", "sometimes"});
  EXPECT_EQ(plumbline({"hunt", *folder_ / "hunt.yaml"}).code, 2);
  EXPECT_EQ(plumbline({"hunt", "-o", out}).code, 2);
  const Outcome occupied = hunt("hunt.yaml", *folder_ / "found");
  EXPECT_EQ(occupied.code, 2);
  EXPECT_NE(occupied.err.find("exists and is not empty"), std::string::npos) << occupied.err;
}

}  // namespace
}  // namespace plumbline::system_tests
