// SPDX-License-Identifier: Apache-2.0
// Bad input: exit 2, one line on stderr that names the place and what would be right, and no run directory.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    plan_ = read_file(project_file("tests/system/short.plan.yaml"));
    scenario_ = read_file(project_file("tests/system/short.yaml"));
  }

  /// The text with the first `from` replaced; `from` must be there.
  static std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  /// Runs the scenario on the plan and expects the refusal to name all of `words`.
  void refuse(const std::string& scenario, const std::string& plan, const std::vector<std::string>& words) {
    write_file(folder_ / "short.yaml", scenario);
    write_file(folder_ / "short.plan.yaml", plan);
    refuse_file("short.yaml", words);
  }

  void refuse_file(const std::string& name, const std::vector<std::string>& words,
                   const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"run", folder_ / name, "--out", folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in: " << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }

  Folder folder_;
  std::string plan_;
  std::string scenario_;
};

TEST_F(BadInput, Files) {
  refuse_file("missing.yaml", {"missing.yaml: no such file"});
  refuse_file("missing.ifc", {"missing.ifc: no such file"});
  fs::create_directory(folder_ / "dir.yaml");
  refuse_file("dir.yaml", {"dir.yaml", "directory"});
  write_file(folder_ / "empty.yaml", "");
  refuse_file("empty.yaml", {"empty.yaml", "empty"});
  write_file(folder_ / "empty.ifc", "");
  refuse_file("empty.ifc", {"empty.ifc", "empty"});
  write_file(folder_ / "words.ifc", "this is no building\nat all\n");
  refuse_file("words.ifc", {"words.ifc"});
  write_file(folder_ / "words.yaml", "just words\n");
  refuse_file("words.yaml", {"words.yaml:1:1", "scenario: 1", "plan: 1"});
  write_file(folder_ / "other.yaml", "sweep: 1\n");
  refuse_file("other.yaml", {"other.yaml:1:1", "sweep"});
  write_file(folder_ / "broken.yaml", "scenario: 1\nname: [a, b\n");
  refuse_file("broken.yaml", {"broken.yaml:"});
}

TEST_F(BadInput, AnIfcFileCutOffInTheMiddle) {
  const std::string ifc = read_file(project_file("tests/data/ifc/workshop.ifc"));
  ASSERT_FALSE(ifc.empty());
  for (const double share : {0.1, 0.5, 0.9}) {
    write_file(folder_ / "cut.ifc", ifc.substr(0, static_cast<std::size_t>(share * static_cast<double>(ifc.size()))));
    refuse_file("cut.ifc", {"cut.ifc"});
  }
}

TEST_F(BadInput, ScenarioKeysAndValues) {
  refuse(with(scenario_, "speed_mps:", "speed_msp:"), plan_,
         {"short.yaml:9:", "unknown key 'speed_msp'", "'speed_mps'"});
  refuse(scenario_ + "seed: 4\n", plan_, {"short.yaml:16:1", "duplicate key 'seed'"});
  refuse(with(scenario_, "seed: 3", "seed: three"), plan_, {"short.yaml:6:7", "whole number"});
  refuse(with(scenario_, "speed_mps: 0.6", "speed_mps: 60"), plan_, {"short.yaml:9:", "between"});
  refuse(with(scenario_, "odometry, vgicp", "odometry, vgcip"), plan_,
         {"short.yaml:12:", "unknown method 'vgcip'", "'vgicp'"});
  refuse(with(scenario_, "odometry, vgicp", "odometry, hdl_slam"), plan_,
         {"short.yaml:12:", "method 'hdl_slam' is now called 'keyframe_graph'"});
  refuse(with(scenario_, "short.plan.yaml", "none.plan.yaml"), plan_, {"short.yaml:5:", "none.plan.yaml"});
  refuse(with(scenario_, "method: truth", "method: nobody"), plan_, {"short.yaml:14:", "nobody"});
  refuse(with(scenario_, "metric: ate_aligned_rmse_m", "metric: ate"), plan_,
         {"unknown metric 'ate'; did you mean 'ate_rmse_m', 'ate_aligned_rmse_m' or 'ate_final_rmse_m'?"});
  refuse(with(scenario_, "metric: ate_aligned_rmse_m", "metric: none_of_them"), plan_,
         {"unknown metric 'none_of_them'; docs/reference/metrics.md lists them"});
  // Such a gate can only fail.
  refuse(with(scenario_, "metric: ate_aligned_rmse_m, method: vgicp",
              "metric: rooms.recall, method: s_graph_localization"),
         plan_, {"short.yaml:15:", "'s_graph_localization' never has 'rooms.recall'", "of SLAM"});
  refuse(with(scenario_, "metric: ate_aligned_rmse_m, method: vgicp", "metric: localization.ape_rmse_m, method: vgicp"),
         plan_, {"short.yaml:15:", "'vgicp' never has 'localization.ape_rmse_m'", "does not localize"});
  write_file(folder_ / "short.yaml", with(scenario_, "method: vgicp", "method: vgipc"));
  refuse_file("short.yaml", {"short.yaml:15:", "unknown method 'vgipc'", "'vgicp'"}, {"--method", "truth"});
  write_file(folder_ / "short.yaml", with(scenario_, "odometry, vgicp", "odometry, vgcip"));
  refuse_file("short.yaml", {"short.yaml:12:", "unknown method 'vgcip'", "'vgicp'"}, {"--method", "truth"});
  refuse(with(scenario_, "name: short", "name: caf\xe9"), plan_, {"short.yaml:4:10", "no UTF-8"});
}

TEST_F(BadInput, StartAndRoute) {
  refuse(with(scenario_, "{room: left}", "{at: [5, 2]}"), plan_, {"short.yaml:7:", "inside a wall"});
  refuse(with(scenario_, "{room: left}", "{at: [30, 2]}"), plan_, {"short.yaml:7:", "outside every room"});
  refuse(with(scenario_, "{room: left}", "{room: lift}"), plan_, {"short.yaml:7:", "'left'"});
  refuse(with(scenario_, "{room: left}", "{room: left, storey: ground}"), plan_, {"short.yaml:7:", "takes no storey"});
  refuse(with(scenario_, "{room: left}", "{storey: first, at: [2, 2]}"), plan_, {"short.yaml:7:", "storey 'first'"});
  refuse(with(scenario_, "[hall, right]", "[hall, closet]"), plan_, {"short.yaml:8:23", "closet", "cannot be reached"});
  refuse(with(scenario_, "[hall, right]", "[]"), plan_, {"short.yaml:8:16", "names no room"});
  refuse(with(scenario_, "[hall, right]", "[hall, cellar]"), plan_, {"short.yaml:8:23", "unknown room 'cellar'"});
}

TEST_F(BadInput, APlanWithoutRoomsForAMethodThatStartsFromRooms) {
  const std::size_t rooms = plan_.find("rooms:"), after = plan_.find("materials:");
  ASSERT_LT(rooms, after);
  const std::string plan = plan_.substr(0, rooms) + plan_.substr(after);
  const std::string scenario =
      with(with(scenario_, "{room: left}", "{at: [2, 2]}"), "{rooms: [hall, right]}", "{rooms: all}");
  write_file(folder_ / "short.yaml", scenario);
  write_file(folder_ / "short.plan.yaml", plan);
  refuse_file("short.yaml", {"--method", "s_graph_localization", "rooms", "short.plan.yaml"},
              {"--method", "s_graph_localization"});
  refuse_file("short.plan.yaml", {"--method", "s_graph_localization", "rooms"}, {"--method", "s_graph_localization"});
}

TEST_F(BadInput, Plan) {
  refuse(scenario_, with(plan_, "b: [9, 0]", "b: [0, 0]"), {"short.plan.yaml:7:", "south"});
  refuse(scenario_, with(plan_, "width_m: 1.0", "width_m: 12"), {"short.plan.yaml:15:", "door_left"});
  refuse(scenario_, with(plan_, "[0, 4.4]]}", "[0, 4.4]], walls: [ghost]}"), {"short.plan.yaml:19:", "ghost"});
  refuse(scenario_, with(plan_, "wall: hall_south", "wall: hall_north"), {"short.plan.yaml:15:", "hall_north"});
  refuse(scenario_, with(plan_, "height_m: 2.8", "height_m: -2.8"), {"short.plan.yaml:5:"});
  refuse(scenario_, with(plan_, "name: short", "nmae: short"), {"short.plan.yaml:4:", "'name'"});
}

TEST_F(BadInput, CommandLine) {
  const auto refuse_line = [](const std::vector<std::string>& arguments, const std::string& words = "") {
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  const std::string input = project_file("tests/system/short.yaml");
  refuse_line({}, "name a command");
  refuse_line({"walk"}, "unknown command 'walk'");
  refuse_line({"rnu", input}, "did you mean 'run'?");
  refuse_line({"--versoin"}, "did you mean '--version'?");
  refuse_line({"run"});
  refuse_line({"run", input, "--threads", "0"});
  refuse_line({"run", input, "--sed", "1"}, "unknown option '--sed'; did you mean '--seed'?");
  refuse_line({"generate", "corridor", "--rooms", "4", "--widths", "3", "-o", "-"}, "unknown option '--widths'");
  for (const char* seed : {"-1", "", "1.5", "1e3", "9200000000000000001", "99999999999999999999"})
    refuse_line({"run", input, "--seed", seed, "--out", folder_ / "out"},
                "is not a seed; give a whole number from 0 to");
  refuse_line({"identify", project_file("tests/system/short.plan.yaml"), "--step", "nan"}, "from 0.1 to 5");
  for (const char* until : {"-5", "0", "nan", "inf", "1e300"})
    refuse_line({"replay", folder_ / "nothing", "--until", until}, "a number above 0");
  fs::create_directory(folder_ / "bare");
  for (const char* command : {"score", "report", "replay"})
    refuse_line({command, folder_ / "bare"}, "is no run directory, since it has no scenario.yaml");
  refuse_line({"diff", folder_ / "bare", folder_ / "bare"}, "holds no digests.csv");
  fs::create_directory(folder_ / "records");
  write_file(folder_ / "records/recording.yaml", "recording: 1\n");
  refuse_line({"score", folder_ / "records"}, "is a recording, not a run; run plumbline estimate on it first");
  refuse_line({"inspect"}, "BUILDING: is required: a plan, .ifc or mesh; see plumbline inspect --help");
  refuse_line({"sweep"}, "SWEEP: is required: a sweep file; see plumbline sweep --help");
  refuse_line({"inspect", input}, "this is a scenario, not a plan; name its building, short.plan.yaml");
  write_file(folder_ / "other.yaml", "sweep: 1\n");
  refuse_line({"inspect", folder_ / "other.yaml"}, "not a plan file; the first key must be 'plan: 1'");
  refuse_line({"identify", project_file("tests/system/short.plan.yaml"), "-o", folder_ / "h.txt"}, "must be a page");
  const Outcome too_long = plumbline({"run", input, "--out", folder_ / std::string(300, 'n')});
  EXPECT_EQ(too_long.code, 3);
  EXPECT_TRUE(too_long.err.ends_with("n: cannot be created: File name too long\n")) << too_long.err;
  refuse_line({"score", folder_ / "nothing"});
  refuse_line({"report", folder_ / "nothing"});
  refuse_line({"replay", folder_ / "nothing"});
  refuse_line({"diff", folder_ / "nothing", folder_ / "nothing"});
  refuse_line({"identify", folder_ / "nothing"});
  refuse_line({"identify", project_file("tests/system/short.plan.yaml"), "--storey", "attic"});
  refuse_line({"identify", project_file("tests/system/short.plan.yaml"), "--step", "0"});
  refuse_line({"identify", project_file("tests/system/short.plan.yaml"), "--seeds", "3"}, "--seeds: is of a scenario");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--storey", "attic"}, {"--step", "1"}, {"--across"}, {"--compass"}, {"--force"}}) {
    std::vector<std::string> line = {"identify", input};
    line.insert(line.end(), words.begin(), words.end());
    refuse_line(line, words.front() + ": is for a building");
  }
  refuse_line({"identify", input, "-o", folder_ / "page.html"}, "--out: is for a building");
  write_file(folder_ / "short.yaml", scenario_);
  write_file(folder_ / "short.plan.yaml", plan_);
  refuse_file("short.yaml", {"unknown method 'vgcip'", "'vgicp'"}, {"--method", "truth,vgcip"});
  refuse_file("short.yaml",
              {"--method: method 's_graphs_plus_paper.lidar' is now called 's_graphs_plus_all_walls.lidar'"},
              {"--method", "truth,s_graphs_plus_paper.lidar"});
  refuse_file("short.yaml", {"twice"}, {"--method", "truth,truth"});
}

TEST(Stdout, AReaderThatHasSeenEnoughIsNoError) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY is not set; run through ctest";
  Setting through_head;
  through_head.wrapper = {"bash", "-c", R"("$@" | head -c 1 >/dev/null; echo "${PIPESTATUS[0]}")", "-"};
  const Outcome outcome = plumbline({"scenarios", "--schema"}, through_head);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(outcome.out == "141\n" || outcome.out == "0\n") << outcome.out;  // 0: all had gone into the pipe before
}

TEST(Help, EveryCommandShowsAnExample) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY is not set; run through ctest";
  for (const char* command : {"run", "simulate", "estimate", "score", "report", "replay", "diff", "methods",
                              "scenarios", "identify", "sweep"}) {
    const Outcome outcome = plumbline({command, "--help"});
    EXPECT_EQ(outcome.code, 0) << command;
    EXPECT_NE(outcome.out.find("Example: plumbline " + std::string(command)), std::string::npos) << outcome.out;
  }
  EXPECT_NE(plumbline({"generate", "--help"}).out.find("Usage: plumbline generate FAMILY [OPTIONS]\n"),
            std::string::npos);
  EXPECT_EQ(plumbline({"--version"}).out.rfind("plumbline ", 0), 0U);
}

}  // namespace
}  // namespace plumbline::system_tests
