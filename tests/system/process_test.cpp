// SPDX-License-Identifier: Apache-2.0
// Methods that are processes: what they answer counts as a built-in method's, and what they do harms nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

const std::string python = "/usr/bin/python3";

bool has_numpy() { return std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) == 0; }

class Process : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  static std::string program(const std::string& name) {
    return (fs::path(std::getenv("PLUMBLINE_BINARY")).parent_path() / "tests" / name).string();
  }
  /// A short walk with these methods, in YAML.
  [[nodiscard]] std::string scenario(const std::string& methods, const std::string& seconds = "4") const {
    fs::copy_file(project_file("tests/system/short.plan.yaml"), folder_ / "short.plan.yaml",
                  fs::copy_options::skip_existing);
    const std::string path = folder_ / "walk.yaml";
    write_file(path,
               "scenario: 1\nname: walk\nbuilding: short.plan.yaml\nseed: 3\nstart: {room: left}\n"
               "route: {rooms: [hall, right]}\nduration_s: " +
                   seconds + "\nmethods:\n" + methods);
    return path;
  }
  static nlohmann::json json(const std::string& path) { return nlohmann::json::parse(read_file(path)); }

  Folder folder_;
};

TEST_F(Process, VgicpWrappedGivesTheBuiltInsBytes) {
  const std::string input = scenario("  - vgicp\n  - vgicp.lidar\n  - {name: mine, command: [" +
                                         program("process_vgicp") + "], repeat: true}\n  - {name: alone, command: [" +
                                         program("process_vgicp") + "]}\n  - alone.lidar\n",
                                     "8");
  std::string text = read_file(input);
  text.replace(text.find("  - {name: alone"), text.find("  - alone.lidar") - text.find("  - {name: alone"), "");
  text += "processes:\n  - {name: alone, command: [" + program("process_vgicp") + "]}\n";
  write_file(input, text);
  const std::string out = folder_ / "run";
  const Outcome outcome = plumbline({"run", input, "-o", out});
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(read_file(out + "/mine.tum"), read_file(out + "/vgicp.tum"));
  EXPECT_EQ(read_file(out + "/mine.final.tum"), read_file(out + "/vgicp.final.tum"));
  EXPECT_EQ(read_file(out + "/alone.lidar.tum"), read_file(out + "/vgicp.lidar.tum"));
  EXPECT_NE(read_file(out + "/vgicp.tum"), read_file(out + "/vgicp.lidar.tum"));

  const Outcome again = plumbline({"replay", out});
  EXPECT_EQ(again.code, 0) << again.out << again.err;
}

TEST_F(Process, TheBridgeToRos2GivesWhatComesBackFromThere) {
  if (!has_numpy()) GTEST_SKIP() << "no numpy for " << python;
  const std::string stub = project_file("tests/processes/ros2_stub/bridge.py");
  const std::string bridge = project_file("slam/process/client/examples/ros2_bridge.py");
  const Outcome outcome = plumbline({"run",
                                     scenario("  - odometry\n  - {name: bridge, command: [" + python + ", " + stub +
                                                  ", " + bridge + ", --wait-s, '60'], repeat: true}\n",
                                              "3"),
                                     "-o", folder_ / "run"});
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const nlohmann::json methods = json(folder_ / "run/results.json")["methods"];
  EXPECT_EQ(methods["bridge"]["verdict"], "complete") << outcome.out;
  // The stand-in answers with the odometry that it got last.
  EXPECT_EQ(methods["bridge"]["rpe_1m_rmse_m"].is_null(), methods["odometry"]["rpe_1m_rmse_m"].is_null());
  EXPECT_NEAR(methods["bridge"]["ate_aligned_rmse_m"].get<double>(),
              methods["odometry"]["ate_aligned_rmse_m"].get<double>(), 1e-3);
}

TEST_F(Process, ThePythonExampleFollowsAndRepeats) {
  if (!has_numpy()) GTEST_SKIP() << "no numpy for " << python;
  const std::string icp = project_file("slam/process/client/examples/icp.py");
  const Outcome outcome = plumbline({"run",
                                     scenario("  - {name: icp, command: [" + python + ", " + icp +
                                                  "], repeat: true}\n"
                                                  "  - icp.lidar\n",
                                              "6"),
                                     "-o", folder_ / "run"});
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const nlohmann::json results = json(folder_ / "run/results.json");
  EXPECT_EQ(results["methods"]["icp"]["verdict"], "complete");
  // Scans are not deskewed: measured 3 cm.
  EXPECT_LT(results["methods"]["icp"]["ate_aligned_rmse_m"].get<double>(), 0.2);
  EXPECT_EQ(read_file(folder_ / "run/icp.tum"), read_file(folder_ / "run/icp.lidar.tum"));
}

/// The first block of this language in the guide.
std::string guide_block(const std::string& language) {
  const std::string text = read_file(project_file("docs/guide/your_method.md")), begin = "```" + language + "\n";
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find("```\n", from) - from);
}

// A stranger's path: the guide's script as it stands, on a stand-in with the public KISS-ICP's interface.
TEST_F(Process, TheGuidesKissIcpConformsAndRuns) {
  if (!has_numpy()) GTEST_SKIP() << "no numpy for " << python;
  const std::string script = guide_block("python");
  EXPECT_LE(std::count(script.begin(), script.end(), '\n'), 60);
  write_file(folder_ / "my_kiss.py", script);
  Setting here;
  here.cwd = folder_ / "";
  here.env["PYTHONPATH"] = project_file("tests/processes/kiss_icp");
  const Outcome tried = plumbline({"conformance", python, "my_kiss.py"}, here);
  EXPECT_EQ(tried.code, 0) << tried.out << tried.err;
  for (const std::string words : {"ok    follows the walk", "ok    repeats", "ok    takes LiDAR alone", "conforms\n"})
    EXPECT_NE(tried.out.find(words), std::string::npos) << words << ":\n" << tried.out;

  const Outcome run = plumbline(
      {"run", scenario("  - odometry\n", "6"), "--method", "kiss=" + python + " my_kiss.py", "-o", folder_ / "run"},
      here);
  ASSERT_EQ(run.code, 0) << run.out << run.err;
  const nlohmann::json kiss = json(folder_ / "run/results.json")["methods"]["kiss"];
  EXPECT_EQ(kiss["verdict"], "complete");
  // The robot sways, which the stand-in's planar deskewing leaves out: measured 3 cm.
  EXPECT_LT(kiss["ate_aligned_rmse_m"].get<double>(), 0.1);
}

/// Of plumbline conformance with these words.
Outcome tried(const std::vector<std::string>& words) {
  std::vector<std::string> arguments = {"conformance"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  return plumbline(arguments);
}

void wrong(const std::vector<std::string>& words, const std::string& said) {
  const Outcome outcome = tried(words);
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_NE(outcome.out.find("WRONG"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(said), std::string::npos) << outcome.out;
}

TEST_F(Process, ConformanceSaysWhatIsWrong) {
  const Outcome good = tried({program("process_vgicp")});
  EXPECT_EQ(good.code, 0) << good.out;
  for (const std::string name : {"./no_such_program", "no_such_program"}) {
    const Outcome none = tried({name});
    EXPECT_EQ(none.code, 2) << none.out;
    EXPECT_NE(none.err.find("there is no program '" + name + "'"), std::string::npos) << none.err;
  }
  wrong({program("hostile_process"), "finish_stays"}, "did not end within 5 s of its last answer");
  wrong({program("hostile_process"), "finish_exits"}, "exited with 7 after its last answer");
  wrong({program("hostile_process"), "finish_signal"}, "was ended by signal 11 after its last answer");
  wrong({program("hostile_process"), "finish_floods"}, "sends more after its estimate, which nobody reads");
  const std::string patient = "600";  // s; floods are not read until then
  wrong({"--quiet", "--scan-s", patient, program("hostile_process"), "floods"},
        "at scan 11 (1.1 s): printed more than 16 MiB for one answer");
  wrong({"--scan-s", patient, program("hostile_process"), "logs_on"}, "more than 16 MiB of lines for the log");
  wrong({program("hostile_process"), "good"}, "its pose never changes");
  wrong({program("hostile_process"), "good"}, "ok    repeats to the last bit");
  wrong({program("hostile_process"), "particle_otherwise"}, "the same records gave another answer at scan 11; replay");
  wrong({program("hostile_process"), "finish_otherwise"}, "the same records gave another estimate at the end; replay");
  wrong({"'" + program("hostile_process") + "' nan"}, "at scan 11 (1.1 s): the pose is none");
  wrong({"--scan-s", "0.3", program("hostile_process"), "hang"}, "gave no answer within 0.3 s");
  wrong({program("hostile_process"), "no_json"}, "what is no JSON");
  wrong({program("hostile_process"), "no_json"}, "a method that localizes in one is tried with --plan");
  EXPECT_EQ(good.out.find("--plan"), std::string::npos) << good.out;
  for (const std::vector<std::string>& words : {std::vector<std::string>{}, {"--plam", "x"}, {""}, {" "}})
    EXPECT_EQ(tried(words).code, 2);
}

TEST_F(Process, ConformanceSaysWhatIsWrongOfOneInPython) {
  if (!has_numpy()) GTEST_SKIP() << "no numpy for " << python;
  const auto answering = [&](const std::string& answer) {
    write_file(folder_ / "m.py",
               "import numpy as np, plumbline_client\ndef start(recording):\n    return lambda scan: " + answer +
                   "\nplumbline_client.run(start)\n");
    return std::vector<std::string>{python, folder_ / "m.py"};
  };
  wrong(answering("np.eye(3)"), "not of shape (3, 3)");
  wrong(answering("'here'"), "not a str");
  wrong(answering("2 * np.eye(4)"), "last row of a pose must be 0 0 0 1");
  wrong(answering("np.diag([1, 1, -1, 1])"), "scales, shears or mirrors");
  wrong(answering("np.eye(4) * np.nan"), "must be finite");
  wrong(answering("no_such_name"), "NameError: name 'no_such_name' is not defined (m.py, line 3)");
  wrong(answering("plumbline_client.Answer(np.eye(4), state='GONE')"), "or LOST, not 'GONE'");
  wrong(answering("recording.robot_pose(np.eye(3))"), "not of shape (3, 3) (m.py, line 3)");
  wrong(answering("plumbline_client.Answer(None, 1, [(0.5, np.eye(4))])"), "a hypothesis must be (mass, 4x4, 3x3");
  wrong(answering("recording.robot_pose(np.linalg.inv(recording.X_RL) @ np.linalg.inv(scan.odometry_pose()) @ "
                  "recording.X_RL)"),
        "the map in the robot");
  write_file(folder_ / "m.py",
             "import numpy as np, plumbline_client\nplumbline_client.run(lambda recording: lambda scan: np.eye(4), "
             "lambda: [np.eye(4)])\n");
  wrong({python, folder_ / "m.py"}, "what finish() returns must be (poses, points), not a list of 1");
  write_file(folder_ / "m.py", "import plumbline_client\nplumbline_client.run(lambda recording: None)\n");
  wrong({python, folder_ / "m.py"}, "start() must return the function that answers scans");
}

TEST_F(Process, EstimateTakesOneToo) {
  const std::string input = scenario("  - odometry\n");
  ASSERT_EQ(plumbline({"simulate", input, "-o", folder_ / "rec"}).code, 0);
  ASSERT_EQ(plumbline({"estimate", folder_ / "rec", "--method", "vgicp", "-o", folder_ / "built_in"}).code, 0);
  const Outcome outcome = plumbline({"estimate", folder_ / "rec", "--method",
                                     "mine='" + program("process_vgicp") + "' unused", "-o", folder_ / "mine"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read_file(folder_ / "mine/mine.tum"), read_file(folder_ / "built_in/vgicp.tum"));
}

// 64 rings of 1,024 columns, as one row of 65,536.
TEST_F(Process, SeesAScanOfOneLongRow) {
  const std::string input = scenario("  - odometry\nlidar: {model: os1_64}\n", "2");
  ASSERT_EQ(plumbline({"simulate", input, "--mcap", "-o", folder_ / "rec"}).code, 0);
  const auto estimate = [&](const std::string& method, const std::string& out) {
    const Outcome outcome = plumbline({"estimate", folder_ / "rec/recording.mcap", "--sensors", "lidar", "--without",
                                       "rings", "--method", method, "-o", folder_ / out});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  estimate("vgicp", "built_in");
  estimate("mine=" + program("process_vgicp"), "mine");
  EXPECT_EQ(read_file(folder_ / "mine/mine.lidar.tum"), read_file(folder_ / "built_in/vgicp.lidar.tum"));
}

// All in one run: each crashes for its own reason, and who did right stands.
TEST_F(Process, WhateverItDoesOnlyItselfHasCrashed) {
  const std::map<std::string, std::string> reasons = {
      {"exit", "at scan 11 (1.1 s): exited with 3"},
      {"signal", "was ended by signal 11"},
      {"hang", "gave no answer within 0.5 s"},
      {"ignores_signals", "gave no answer within 0.5 s"},
      {"grandchild", "at scan 11 (1.1 s): exited with 0"},
      {"closes", "closed the connection"},
      {"garbage", "sent what is no message"},
      {"huge", "at most 256 MiB are taken"},
      {"announces", "gave no answer within 0.5 s"},
      {"short", "is shorter than it says"},
      {"long", "8 bytes left where 0 should follow"},
      {"type", "a message of type 131 where 130 is due"},
      {"logs_on", "gave no answer within 0.5 s"},
      {"drip", "gave no answer within 0.5 s"},
      {"fails", "gave up: no wall in sight"},
      {"fails_at_length", "xxx... (5000000 characters in all)"},
      {"stamp", "is for the time"},
      {"nan", "the pose is none"},
      {"quaternion", "the pose is none"},
      {"far", "the pose is none"},
      {"state", "has the state 9"},
      {"hypotheses", "has hypotheses, which only a localization"},
      {"otherwise", "does not repeat"},
      {"twice", "at scan 12"},
      {"dies_at_once", "exited with 7; the last it printed: libcuda is missing"},
      {"old", "speaks another protocol"},
      {"no_json", "no JSON"},
      {"never_greets", "gave no answer within 0.5 s"},
      {"never_reads", "at scan 1 (0.1 s): "},
      {"no_poses", "bytes left where"},
  };
  std::string methods = "  - odometry\n  - {name: good, command: [" + program("hostile_process") +
                        ", good]}\n  - {name: missing, command: [./no_such_program]}\n";
  for (const std::string name : {"floods", "logs"})
    methods += "  - {name: " + name + ", command: [" + program("hostile_process") + ", " + name + "]}\n";
  methods += "  - {name: finish_floods, command: [" + program("hostile_process") + ", finish_floods], finish_s: 1}\n";
  for (const auto& [how, reason] : reasons)
    methods += "  - {name: " + how + ", command: [" + program("hostile_process") + ", " + how +
               "], scan_s: 0.5, start_s: 0.5, finish_s: 5, repeat: " + (how == "otherwise" ? "true" : "false") + "}\n";
  const Outcome outcome = plumbline({"run", scenario(methods, "3"), "-o", folder_ / "run"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;  // without any gate
  EXPECT_TRUE(fs::exists(folder_ / "run/replay.html"));
  const nlohmann::json results = json(folder_ / "run/results.json")["methods"];
  for (const std::string name : {"odometry", "good", "floods", "logs", "finish_floods"})
    EXPECT_EQ(results[name]["verdict"], "complete") << name;
  const auto crashed = [&](const std::string& name, const std::string& reason) {
    EXPECT_EQ(results[name]["verdict"], "crashed") << name;
    const std::string error = json(folder_ / ("run/" + name + ".estimate.json")).value("crashed", "");
    EXPECT_NE(error.find(reason), std::string::npos) << name << ": " << error;
  };
  crashed("missing", "cannot be started: No such file or directory");
  for (const auto& [how, reason] : reasons) crashed(how, reason);
}

/// Whether a process is there and does something.
bool runs(const std::string& pid) {
  const std::string stat = "/proc/" + pid + "/stat";
  return fs::exists(stat) && read_file(stat).find(") Z ") == std::string::npos;
}

TEST_F(Process, WhatItStartedEndsWithItInWhateverSession) {
  Setting setting;
  const std::string file = folder_ / "pid";
  setting.env["HOSTILE_PID_FILE"] = file;
  const Outcome outcome = plumbline({"conformance", program("hostile_process"), "session"}, setting);
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  std::string pid = read_file(file);
  pid.erase(pid.find_last_not_of('\n') + 1);
  ASSERT_FALSE(pid.empty());
  for (int i = 0; i < 100 && runs(pid); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(runs(pid));
}

TEST_F(Process, ConformanceEndsItsMethodWhenItIsStopped) {
  write_file(folder_ / "slow.sh",
             "#!/bin/sh\necho $$ > " + (folder_ / "pid") + "\nexec " + program("hostile_process") + " hang 3\n");
  fs::permissions(folder_ / "slow.sh", fs::perms::owner_all);
  Setting setting;
  setting.kill_when = [&] { return fs::exists(folder_ / "pid"); };
  setting.signal = SIGTERM;
  const auto before = std::chrono::steady_clock::now();
  const Outcome outcome = plumbline({"conformance", "--scan-s", "100", folder_ / "slow.sh"}, setting);
  EXPECT_EQ(outcome.code, 128 + SIGTERM) << outcome.out << outcome.err;
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(50));
  std::string pid = read_file(folder_ / "pid");
  pid.erase(pid.find_last_not_of('\n') + 1);
  EXPECT_FALSE(runs(pid));
}

/// How often what may go wrong by chance is tried; ci/full asks for 100.
int trials() {
  const char* asked = std::getenv("PLUMBLINE_PROCESS_TRIALS");
  return asked == nullptr ? 6 : std::atoi(asked);
}

// Killed, hanging or silent from any scan on.
TEST_F(Process, EveryOneThatIsKilledOrHangsHasCrashed) {
  std::string methods = "  - odometry\n";
  const std::vector<std::string> ways = {"signal", "hang", "exit", "ignores_signals", "closes", "grandchild"};
  for (int i = 0; i < trials(); ++i)
    methods += "  - {name: k" + std::to_string(i) + ", command: [" + program("hostile_process") + ", " +
               ways[static_cast<std::size_t>(i) % ways.size()] + ", '" + std::to_string(i % 29) + "'], scan_s: 0.3}\n";
  const Outcome outcome = plumbline({"run", scenario(methods, "3"), "-o", folder_ / "run"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const nlohmann::json results = json(folder_ / "run/results.json")["methods"];
  EXPECT_EQ(results["odometry"]["verdict"], "complete");
  int crashed = 0;
  for (int i = 0; i < trials(); ++i) crashed += results["k" + std::to_string(i)]["verdict"] == "crashed" ? 1 : 0;
  EXPECT_EQ(crashed, trials());
  EXPECT_EQ(read_file(folder_ / "run/manifest.csv").find(".partial"), std::string::npos);
}

TEST_F(Process, ItAnswersTheSameEveryTime) {
  std::string methods;
  for (int i = 0; i < trials(); ++i)
    methods += "  - {name: r" + std::to_string(i) + ", command: [" + program("process_vgicp") + "]}\n";
  ASSERT_EQ(plumbline({"run", scenario(methods, "3"), "-o", folder_ / "run"}).code, 0);
  const std::string first = read_file(folder_ / "run/r0.tum");
  EXPECT_GT(first.size(), 1000U);
  for (int i = 1; i < trials(); ++i) EXPECT_EQ(read_file(folder_ / ("run/r" + std::to_string(i) + ".tum")), first) << i;
}

TEST_F(Process, AWrongOneIsRefusedAtItsPlace) {
  const auto refuse = [&](const std::string& methods, const std::string& words) {
    const Outcome outcome = plumbline({"run", scenario(methods), "-o", folder_ / "run"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  refuse("  - {command: [x]}\n", "walk.yaml:9:5: a method that is a process needs a name");
  refuse("  - {name: a/b, command: [x]}\n", "must be 1 to 60 letters");
  refuse("  - {name: vgicp, command: [x]}\n", "'vgicp' is in the table already");
  refuse("  - {name: mine, command: []}\n", "needs a command");
  refuse("  - {name: mine, comand: [x]}\n", "is 'comand' meant to be it?");
  refuse("  - {name: mine, command: [x]}\n  - {name: mine, command: [y]}\n", "in the table already");
  const Outcome outcome = plumbline({"run", scenario("  - odometry\n"), "--method", "mine='x", "-o", folder_ / "run"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("a quote that is not closed"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace plumbline::system_tests
