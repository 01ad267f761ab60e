// SPDX-License-Identifier: Apache-2.0
// What goes wrong around a run: output that cannot be written, a full disk, a kill in the middle, a robot that is
// stuck.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class Trouble : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  static std::string input() { return project_file("tests/system/short.yaml"); }

  /// Sends the signal once the run has begun to write.
  Outcome interrupt(int signal) {
    Setting setting;
    setting.signal = signal;
    setting.kill_when = [&] { return fs::exists(folder_ / "out/.partial/lock"); };
    return plumbline({"run", input(), "--out", folder_ / "out"}, setting);
  }

  Folder folder_;
};

TEST_F(Trouble, OutputThatCannotBeWritten) {
  EXPECT_EQ(plumbline({"run", input(), "--method", "truth", "--out", "/proc/plumbline"}).code, 3);
  Setting nowhere;
  nowhere.cwd = "/proc";
  const Outcome outcome = plumbline({"run", input(), "--method", "truth"}, nowhere);
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("runs/short-3"), std::string::npos) << outcome.err;
}

TEST_F(Trouble, OutputThatIsFull) {
  Setting setting;
  setting.largest_file = 20'000;
  const Outcome outcome = plumbline({"run", input(), "--method", "truth", "--out", folder_ / "out"}, setting);
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("cannot be written"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

// A disk of its own, in a namespace where that needs no rights. It is full when the first run begins, in it, or after
// it.
TEST_F(Trouble, ASweepOnAFullDiskSaysSo) {
  const std::string disk = folder_ / "disk", sweep = folder_ / "sweep.yaml";
  fs::create_directory(disk);
  write_file(sweep, "sweep: 1\nname: full\nscenarios: [" + input() + "]\nseeds: 2\nmethods: [truth]\n");
  const auto with_disk = [&](const std::string& size) {
    Setting setting;
    setting.wrapper = {"unshare", "-Urm", "sh", "-c",
                       "mount -t tmpfs -o size=" + size + " none '" + disk + "' && exec \"$0\" \"$@\""};
    return setting;
  };
  if (plumbline({"methods"}, with_disk("1M")).code != 0) GTEST_SKIP() << "no disk can be mounted without rights here";
  for (const char* size : {"4k", "8k", "16k"}) {
    const Outcome outcome = plumbline({"sweep", sweep, "--out", disk + "/out"}, with_disk(size));
    EXPECT_EQ(outcome.code, 3) << size << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find("cannot be written: No space left on device\n"), std::string::npos) << size << "\n"
                                                                                                   << outcome.err;
  }
}

TEST_F(Trouble, InterruptsLeaveNothing) {
  EXPECT_EQ(interrupt(SIGINT).code, 130);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_EQ(interrupt(SIGTERM).code, 143);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

// timeout signals the process, and then its group.
TEST_F(Trouble, ASignalThatComesTwiceLeavesNothing) {
  Setting setting;
  setting.wrapper = {"timeout", "-s", "TERM", "1.5"};
  EXPECT_EQ(plumbline({"run", input(), "--out", folder_ / "out"}, setting).code, 124);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Trouble, AKillLeavesNothingThatLooksComplete) {
  EXPECT_EQ(interrupt(SIGKILL).code, 128 + SIGKILL);
  for (const auto& entry : fs::directory_iterator(folder_ / "out"))
    EXPECT_EQ(entry.path().filename().string(), ".partial");
  // And it is no obstacle to the next run.
  EXPECT_EQ(plumbline({"run", input(), "--method", "truth", "--out", folder_ / "out"}).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/results.json"));
}

/// Who falls on ice and under blows does so whatever method is asked: exit 4, and the methods' verdicts stand.
TEST_F(Trouble, AFallIsTheScenariosFailureNotAMethods) {
  std::string scenario = read_file(input());
  scenario.replace(scenario.find("short.plan.yaml"), 15, project_file("tests/system/short.plan.yaml"));
  write_file(folder_ / "ice.yaml",
             scenario + "ground: {friction: 0.05}\npushes: {min_n: 400, max_n: 500, every_s: 1}\n");
  const Outcome outcome =
      plumbline({"run", folder_ / "ice.yaml", "--method", "truth,odometry", "--out", folder_ / "out"});
  EXPECT_EQ(outcome.code, 4) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find("the robot fell at "), std::string::npos) << outcome.err;
  const auto results = nlohmann::json::parse(read_file(folder_ / "out/results.json"));
  EXPECT_EQ(results["failure"].get<std::string>().rfind("the robot fell at ", 0), 0U) << results["failure"];
  EXPECT_EQ(results["sensors"]["off_default"],
            nlohmann::json({"ground.friction: 0.05", "pushes.min_n: 400", "pushes.max_n: 500", "pushes.every_s: 1"}));
  EXPECT_EQ(results["injected"],
            nlohmann::json({"the ground's friction is 0.05", "the robot is pushed with up to 500 N every 1 s"}));
  EXPECT_NE(read_file(folder_ / "out/report.html").find("<b>Injected faults:</b> the ground"), std::string::npos);
  EXPECT_NE(outcome.out.find("injected: the ground's friction is 0.05\n"), std::string::npos) << outcome.out;
  for (const auto& [name, method] : results["methods"].items()) EXPECT_EQ(method["verdict"], "complete") << name;
  EXPECT_NE(read_file(folder_ / "out/report.html").find("the scenario failed</span> <span>the robot fell at "),
            std::string::npos);
  EXPECT_NE(read_file(folder_ / "out/junit.xml").find("failure message=\"the robot fell at "), std::string::npos);
}

TEST_F(Trouble, ReadOnlyFolderAndNoStdin) {
  Setting setting;
  setting.cwd = "/proc";
  setting.close_stdin = true;
  EXPECT_EQ(plumbline({"run", input(), "--method", "truth", "--out", folder_ / "out"}, setting).code, 0);
  EXPECT_EQ(plumbline({"methods"}, setting).code, 0);
  EXPECT_EQ(plumbline({"scenarios", project_file("scenarios/library")}, setting).code, 0);
  EXPECT_EQ(plumbline({"score", folder_ / "out"}, setting).code, 0);
  EXPECT_EQ(plumbline({"report", folder_ / "out"}, setting).code, 0);
}

}  // namespace
}  // namespace plumbline::system_tests
