// SPDX-License-Identifier: Apache-2.0
// The real program on a short scenario: its files, and that nothing around it changes their bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/system/program.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Every file but timings.json must have the same bytes.
void expect_equal(const std::string& a, const std::string& b) {
  ASSERT_EQ(names_in(a), names_in(b));
  for (const std::string& name : names_in(a)) {
    if (name == "timings.json") continue;
    EXPECT_TRUE(read_file(a + "/" + name) == read_file(b + "/" + name)) << name;
  }
}

class ShortRun : public RunOnce<ShortRun> {
 public:
  static Outcome begin() { return plumbline({"run", input(), "--out", dir(), "--threads", "2", "--record"}); }

 protected:
  static std::string input() { return project_file("tests/system/short.yaml"); }
  static std::string dir() { return *folder_ / "short"; }
};

TEST_F(ShortRun, LeavesTheFilesOfTheContract) {
  for (const char* name :
       {"scenario.yaml", "results.json", "timings.json", "digests.csv", "truth.tum", "report.html", "junit.xml",
        "building.plan.yaml", "truth_surface.ply", "vgicp.tum", "vgicp.final.tum", "vgicp.map.ply", "vgicp.map.pcd",
        "s_graph_localization.hypotheses.jsonl", "recording/lidar.pcap", "recording/odometry.tum", "recording/imu.csv",
        "recording/recording.yaml", "recording/odometry_covariance.csv"})
    EXPECT_GT(read_file(dir() + "/" + name).size(), 0U) << name;
  EXPECT_EQ(outcome_->err, "");  // stderr is no terminal here
  EXPECT_NE(outcome_->out.find("gates: 2 of 2 passed\n"), std::string::npos) << outcome_->out;
}

TEST_F(ShortRun, ResultsAndTimingsHaveTheKeysOfTheContract) {
  const auto results = nlohmann::json::parse(read_file(dir() + "/results.json"));
  EXPECT_EQ(results["scenario"], "short");
  EXPECT_EQ(results["seed"], "3");
  EXPECT_EQ(results["digest"].get<std::string>().size(), 16U);
  EXPECT_GT(results["distance_m"], 3.0);
  EXPECT_GT(results["duration_s"], 8.0);
  const auto& methods = results["methods"];
  EXPECT_EQ(methods["truth"]["verdict"], "complete");
  EXPECT_LT(methods["truth"]["ate_rmse_m"], 1e-9);
  EXPECT_LT(methods["truth"]["map_rmse_m"], 1e-5);  // float coordinates
  for (const char* method : {"odometry", "vgicp", "s_graphs_plus"}) {
    EXPECT_EQ(methods[method]["verdict"], "complete") << method;
    EXPECT_GT(methods[method]["ate_aligned_rmse_m"], 1e-4) << method;  // real estimates are never perfect
    EXPECT_FALSE(methods[method].contains("localization")) << method;
  }
  EXPECT_FALSE(methods["s_graph_localization"].contains("ate_aligned_rmse_m"));
  EXPECT_TRUE(methods["s_graph_localization"]["localization"].contains("state"));

  const auto timings = nlohmann::json::parse(read_file(dir() + "/timings.json"));
  for (const char* key : {"total_s", "cpu_s", "simulated_s", "peak_rss_mb", "threads", "cpu_features", "stages"})
    EXPECT_TRUE(timings.contains(key)) << key;
  for (const char* stage : {"sim.physics", "sim.lidar", "vgicp/odometry"})
    EXPECT_TRUE(timings["stages"].contains(stage)) << stage;
}

TEST_F(ShortRun, SameBytesAgain) {
  const std::string again = *folder_ / "again";
  ASSERT_EQ(plumbline({"run", input(), "--out", again, "--threads", "2", "--record"}).code, 0);
  expect_equal(dir(), again);
}

TEST_F(ShortRun, SameBytesWithOneThreadElsewhereInAnotherLocale) {
  const std::string other = *folder_ / "other";
  Setting setting;
  setting.cwd = "/";
  setting.one_cpu = true;
  setting.env = {
      {"LC_ALL", "de_DE.UTF-8"}, {"TZ", "Asia/Kathmandu"}, {"HOME", std::nullopt}, {"GLIBC_TUNABLES", std::nullopt}};
  ASSERT_EQ(plumbline({"run", input(), "--out", other, "--threads", "1", "--record"}, setting).code, 0);
  expect_equal(dir(), other);
}

TEST_F(ShortRun, ACopyElsewhereIsScoredReportedAndReplayedTheSame) {
  const std::string copy = *folder_ / "copy";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  for (const char* name : {"results.json", "junit.xml", "report.html"}) fs::remove(copy + "/" + name);
  EXPECT_EQ(plumbline({"score", copy}).code, 0);
  expect_equal(dir(), copy);
  fs::remove(copy + "/report.html");
  EXPECT_EQ(plumbline({"report", copy}).code, 0);
  expect_equal(dir(), copy);

  Setting closed;
  closed.cwd = "/proc";  // nothing can be written here
  closed.close_stdin = true;
  const Outcome replay = plumbline({"replay", copy, "--until", "3"}, closed);
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_EQ(replay.out.rfind("equal: ", 0), 0U) << replay.out;
  EXPECT_EQ(plumbline({"diff", dir(), copy}, closed).out, "equal\n");
}

TEST_F(ShortRun, ReplayAndDiffNameTheFirstDifference) {
  const std::string copy = *folder_ / "changed";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  std::string digests = read_file(copy + "/digests.csv");
  const std::size_t stage = digests.find("vgicp/odometry,", digests.size() / 10);
  ASSERT_NE(stage, std::string::npos);
  char& digit = digests[stage + std::string("vgicp/odometry,").size()];
  digit = digit == '0' ? '1' : '0';
  write_file(copy + "/digests.csv", digests);
  const Outcome altered = plumbline({"replay", copy, "--until", "3"});
  EXPECT_EQ(altered.code, 2);
  EXPECT_NE(altered.err.find("altered since they were written: digests.csv"), std::string::npos) << altered.err;
  const Outcome replay = plumbline({"replay", copy, "--until", "3", "--unchecked"});
  EXPECT_EQ(replay.code, 1);
  EXPECT_NE(replay.out.find(" s in vgicp/odometry: "), std::string::npos) << replay.out;
  const Outcome diff = plumbline({"diff", dir(), copy});
  EXPECT_EQ(diff.code, 1);
  EXPECT_NE(diff.out.find(" s in vgicp/odometry: "), std::string::npos) << diff.out;
  EXPECT_EQ(diff.out.find("look: "), std::string::npos);
  const std::string same = *folder_ / "same & like";
  fs::copy(dir(), same, fs::copy_options::recursive);
  for (const std::string& run : {same, copy}) write_file(run + "/replay.html", "");
  const std::string look = plumbline({"diff", same, copy}).out;
  EXPECT_NE(look.find("look: " + same + "/replay.html#t="), std::string::npos) << look;
  EXPECT_NE(look.find("&with=../changed/replay.html\n"), std::string::npos) << look;
  const std::string back = plumbline({"diff", copy, same}).out;
  EXPECT_NE(back.find("&with=../same%20%26%20like/replay.html\n"), std::string::npos) << back;
}

TEST_F(ShortRun, AlteredFilesAreNamed) {
  const std::string copy = *folder_ / "altered";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  const auto refused = [&](const std::string& command, const std::string& words) {
    const Outcome outcome = plumbline({command, copy});
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  // One method's poses under another's name; a truth that was cut.
  fs::copy_file(copy + "/truth.tum", copy + "/vgicp.tum", fs::copy_options::overwrite_existing);
  for (const char* command : {"score", "report", "replay"}) refused(command, "written: vgicp.tum;");
  const Outcome diff = plumbline({"diff", dir(), copy});
  EXPECT_EQ(diff.code, 0) << "its digests are as they were";
  EXPECT_NE(diff.err.find(copy + ": altered since they were written: vgicp.tum; only digests.csv is compared"),
            std::string::npos)
      << diff.err;
  EXPECT_EQ(diff.err.find(dir() + ": "), std::string::npos) << diff.err;
  const std::string results = read_file(copy + "/results.json");
  write_file(copy + "/results.json", results + "\n");
  EXPECT_NE(plumbline({"diff", dir(), copy}).err.find("altered since they were written: results.json, vgicp.tum;"),
            std::string::npos);
  write_file(copy + "/results.json", results);
  const std::string truth = read_file(copy + "/truth.tum");
  write_file(copy + "/truth.tum", truth.substr(0, truth.rfind('\n', truth.size() - 2) + 1));
  refused("score", "written: truth.tum, vgicp.tum;");
  const Outcome taken = plumbline({"score", copy, "--unchecked"});
  EXPECT_NE(taken.err.find("truth.tum, vgicp.tum; taken as they are"), std::string::npos) << taken.err;
  const auto unchecked = nlohmann::json::parse(read_file(copy + "/results.json"))["unchecked"];
  EXPECT_EQ(unchecked, (nlohmann::json{"truth.tum", "vgicp.tum"}));
  refused("score", "written: truth.tum, vgicp.tum;");  // it stays so
  fs::copy_file(dir() + "/truth.tum", copy + "/truth.tum", fs::copy_options::overwrite_existing);
  fs::copy_file(dir() + "/vgicp.tum", copy + "/vgicp.tum", fs::copy_options::overwrite_existing);
  EXPECT_EQ(plumbline({"score", copy}).code, 0);
  expect_equal(dir(), copy);

  fs::copy_file(copy + "/vgicp.estimate.json", copy + "/added.estimate.json");
  EXPECT_EQ(plumbline({"report", copy}).code, 2);
  fs::remove(copy + "/added.estimate.json");
  write_file(copy + "/results.json", "{}");
  refused("report", "written: results.json;");
  // A row that is gone does not hide what was altered.
  ASSERT_EQ(plumbline({"score", copy, "--unchecked"}).code, 0);
  std::string manifest = read_file(copy + "/manifest.csv");
  const std::size_t row = manifest.find("vgicp.tum,");
  manifest.erase(row, manifest.find('\n', row) + 1 - row);
  write_file(copy + "/manifest.csv", manifest);
  for (const char* command : {"score", "report", "replay"}) refused(command, "written: manifest.csv (a line of");
  EXPECT_EQ(plumbline({"score", copy, "--unchecked"}).code, 0);
  refused("score", "written: manifest.csv (a line of");  // it stays so
  fs::remove(copy + "/manifest.csv");
  refused("score", "has no manifest.csv");
  EXPECT_EQ(plumbline({"score", copy, "--unchecked"}).code, 0);
}

TEST_F(ShortRun, OutsideTrajectoriesAreScoredLikeOurs) {
  const std::string copy = *folder_ / "outside";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  const Outcome scored = plumbline({"score", copy, "--estimate", "mine=" + dir() + "/vgicp.tum", "--estimate",
                                    "given=" + dir() + "/truth.tum,frame=W"});
  EXPECT_EQ(scored.code, 0) << scored.out << scored.err;
  const auto results = nlohmann::json::parse(read_file(copy + "/results.json"));
  EXPECT_EQ(results["methods"]["mine"]["ate_aligned_rmse_m"], results["methods"]["vgicp"]["ate_aligned_rmse_m"]);
  // Held to what is asked of an estimator, not to the 1e-9 that the truth must keep.
  std::vector<double> asked;
  for (const auto& gate : results["gates"])
    if (gate["method"] == "mine") asked.push_back(gate["limit"]);
  EXPECT_EQ(asked, std::vector<double>{0.25});
  EXPECT_EQ(results["methods"]["given"]["verdict"], "success");
  EXPECT_LT(results["methods"]["given"]["localization"]["ape_rmse_m"], 1e-9);
  EXPECT_NE(read_file(copy + "/report.html").find("mine"), std::string::npos);
  EXPECT_EQ(plumbline({"score", copy, "--estimate", "vgicp=" + dir() + "/vgicp.tum"}).code, 2);
  EXPECT_EQ(plumbline({"score", copy, "--estimate", "x=" + dir() + "/missing.tum"}).code, 2);
}

TEST_F(ShortRun, TrajectoriesThatCannotBeScoredAreRefusedAndNotKept) {
  const std::string copy = *folder_ / "refusing";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  const auto refuse = [&](const std::vector<std::string>& estimates, const std::string& words) {
    std::vector<std::string> arguments = {"score", copy};
    for (const std::string& estimate : estimates) arguments.insert(arguments.end(), {"--estimate", estimate});
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(copy + "/e.estimate.json"));
  };
  write_file(*folder_ / "late.tum", "1700000000.1 0 0 0 0 0 0 1\n1700000000.2 1 0 0 0 0 0 1\n");
  refuse({"e=" + *folder_ / "late.tum"}, "1700000000.100000000 to 1700000000.200000000 s, the scans are of 0.1");
  write_file(*folder_ / "far.tum", "0.1 0 0 0 0 0 0 1\n0.2 1e160 0 0 0 0 0 1\n");
  refuse({"e=" + *folder_ / "far.tum"}, "far.tum:2:1: a position's coordinates");
  refuse({"e=" + dir() + "/vgicp.tum", "e=" + dir() + "/truth.tum"}, "'e' is given twice");
  refuse({"e=" + dir() + "/vgicp.tum,frame=X"}, "'frame=X' must be frame=W");
  EXPECT_EQ(plumbline({"score", copy}).code, 0);
}

TEST_F(ShortRun, AnEstimateThatCrashedOrStoppedFails) {
  const std::string copy = *folder_ / "stopped", crashed = *folder_ / "crashed";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  fs::create_directory(crashed);
  auto estimate = nlohmann::json::parse(read_file(dir() + "/vgicp.estimate.json"));
  estimate["crashed"] = "out of memory";
  write_file(crashed + "/vgicp.estimate.json", estimate.dump());
  write_file(crashed + "/vgicp.tum", "");
  const Outcome outcome = plumbline({"score", copy, "--unchecked", "--estimate", "e=" + crashed});
  EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("of e is absent, must be <= 0.25: the method crashed"), std::string::npos) << outcome.out;

  const std::string truth = read_file(dir() + "/truth.tum");
  write_file(*folder_ / "short.tum", truth.substr(0, truth.find('\n', truth.size() / 2) + 1));
  EXPECT_EQ(plumbline({"score", copy, "--estimate", "half=" + *folder_ / "short.tum,frame=W"}).code, 1);
  const auto results = nlohmann::json::parse(read_file(copy + "/results.json"));
  EXPECT_EQ(results["methods"]["half"]["verdict"], "false_convergence");
  EXPECT_EQ(plumbline({"score", copy, "--estimate", "truth=" + dir() + "/vgicp.tum"}).code, 2);
}

// What a name stood for before leaves nothing behind.
TEST_F(ShortRun, AnEstimateGivenAgainReplacesTheOneOfItsName) {
  const std::string copy = *folder_ / "given_again", one = *folder_ / "one";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  fs::create_directory(one);
  for (const char* end : {".estimate.json", ".tum", ".final.tum", ".map.ply", ".map.pcd"})
    fs::copy_file(dir() + "/vgicp" + end, one + "/vgicp" + end);
  ASSERT_EQ(plumbline({"score", copy, "--unchecked", "--estimate", "e=" + one}).code, 0);
  EXPECT_TRUE(nlohmann::json::parse(read_file(copy + "/results.json"))["methods"]["e"].contains("map_rmse_m"));
  ASSERT_EQ(plumbline({"score", copy, "--estimate", "e=" + one + "/vgicp.tum"}).code, 0);
  EXPECT_FALSE(nlohmann::json::parse(read_file(copy + "/results.json"))["methods"]["e"].contains("map_rmse_m"));
}

TEST_F(ShortRun, AnOutsideEstimateIsDroppedWithAllItsFiles) {
  const std::string copy = *folder_ / "dropping";
  fs::copy(dir(), copy, fs::copy_options::recursive);
  const std::string results = read_file(copy + "/results.json"), page = read_file(copy + "/report.html");
  ASSERT_EQ(plumbline({"score", copy, "--estimate", "e=" + dir() + "/vgicp.tum"}).code, 0);
  ASSERT_FALSE(read_file(copy + "/results.json") == results);
  for (const auto& [name, words] : {std::pair{"vgicp", "only outside estimates can be dropped"},
                                    std::pair{"f", "there is no outside estimate 'f'"}}) {
    const Outcome refused = plumbline({"score", copy, "--drop", name});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find(words), std::string::npos) << refused.err;
  }
  ASSERT_EQ(plumbline({"score", copy, "--drop", "e"}).code, 0);
  EXPECT_TRUE(read_file(copy + "/results.json") == results);
  EXPECT_TRUE(read_file(copy + "/report.html") == page);
  for (const fs::directory_entry& entry : fs::directory_iterator(copy))
    EXPECT_NE(entry.path().filename().string().rfind("e.", 0), 0U) << entry.path();
}

TEST_F(ShortRun, AnotherSeedGivesAnotherRun) {
  const std::string other = *folder_ / "seed";
  ASSERT_EQ(plumbline({"run", input(), "--out", other, "--seed", "4", "--method", "truth"}).code, 0);
  const Outcome diff = plumbline({"diff", dir(), other});
  EXPECT_EQ(diff.code, 1);
  EXPECT_NE(diff.out.find(" in sim."), std::string::npos) << diff.out;
}

TEST_F(ShortRun, OccupiedOutputIsRefusedUnlessForced) {
  const Outcome refused = plumbline({"run", input(), "--out", dir()});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--force"), std::string::npos);
  const std::string other = *folder_ / "forced";
  fs::copy(dir(), other, fs::copy_options::recursive);
  EXPECT_EQ(plumbline({"run", input(), "--out", other, "--method", "truth", "--force"}).code, 0);
  EXPECT_FALSE(fs::exists(other + "/vgicp.tum"));
}

TEST_F(ShortRun, ReplayComparesSomething) {
  const Outcome outcome = plumbline({"replay", dir(), "--until", "0.001"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  EXPECT_NE(outcome.err.find("holds no digest up to then; the first is at 0."), std::string::npos) << outcome.err;
}

TEST(WalkedFloors, TheRobotWalksDownARampToASunkenRoom) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  const Outcome outcome = plumbline(
      {"run", project_file("tests/data/ifc/ramp_house.ifc"), "--method", "odometry", "--out", folder / "run"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("through 3 of the 3 rooms on EG"), std::string::npos) << outcome.out << outcome.err;
  std::istringstream lines(read_file(folder / "run" + "/truth.tum"));
  double lowest = 1e3, highest = -1e3;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream numbers(line);
    double stamp = 0.0, x = 0.0, y = 0.0, z = 0.0;
    numbers >> stamp >> x >> y >> z;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  EXPECT_NEAR(highest - lowest, 0.5, 0.05) << "of the gait, 5 cm";
}

TEST(WalkedFloors, ARobotOnARampIsLocalizedAtItsHeight) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  const Outcome outcome = plumbline({"run", project_file("tests/data/ifc/ramp_house.ifc"), "--method",
                                     "s_graph_localization", "--out", folder / "run"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const auto results = nlohmann::json::parse(read_file(folder / "run" + "/results.json"));
  const nlohmann::json& method = results["methods"]["s_graph_localization"];
  EXPECT_EQ(method["verdict"], "success");
  // 0.26 m at the height of the storey everywhere; 0.045 m on the floors.
  EXPECT_LT(method["localization"]["ape_rmse_m"], 0.1);
}

TEST(Walk, IsPlannedAlikeByInspectAndByRunWithoutSlabs) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "room.plan.yaml",
             "plan: 1\nstoreys: [{id: g}]\nwalls:\n  - {id: s, storey: g, a: [0, 0], b: [3.2, 0]}\n"
             "  - {id: e, storey: g, a: [3.2, 0], b: [3.2, 3.2]}\n  - {id: n, storey: g, a: [3.2, 3.2], b: [0, 3.2]}\n"
             "  - {id: w, storey: g, a: [0, 3.2], b: [0, 0]}\n"
             "rooms: [{id: r, storey: g, polygon: [[0, 0], [3.2, 0], [3.2, 3.2], [0, 3.2]]}]\n");
  ASSERT_EQ(plumbline({"inspect", folder / "room.plan.yaml", "--ifc", folder / "whole.ifc"}).code, 0);
  std::istringstream whole(read_file(folder / "whole.ifc"));
  std::string bare, line;
  while (std::getline(whole, line))
    if (line.find("IFCSLAB(") == std::string::npos) bare += line + "\n";
  write_file(folder / "bare.ifc", bare);
  const Outcome inspected = plumbline({"inspect", folder / "bare.ifc", "--walk", folder / "walk.html"});
  const Outcome walked = plumbline({"run", folder / "bare.ifc", "--method", "truth", "--out", folder / "out"});
  const std::size_t at = walked.out.find("planned walk: ");
  ASSERT_NE(at, std::string::npos) << walked.out << walked.err;
  const std::string planned = walked.out.substr(at + 14, walked.out.find('\n', at) - at - 14);
  EXPECT_NE(inspected.out.find("g: " + planned + "\n"), std::string::npos) << planned << " in " << inspected.out;
}

}  // namespace
}  // namespace plumbline::system_tests
