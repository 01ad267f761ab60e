// SPDX-License-Identifier: Apache-2.0
// How the program answers what is odd about its input, without harm to a terminal, to memory or to files beside.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bim/config/input_file.h"
#include "slam/io/recordings/tum.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class Manners : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  static std::string input() { return project_file("tests/system/short.yaml"); }

  /// Exit 2 with one line that has these words.
  static void refuse(const std::vector<std::string>& arguments, const std::string& words, const Setting& setting = {}) {
    const Outcome outcome = plumbline(arguments, setting);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }

  Folder folder_;
};

TEST_F(Manners, AnEmptyNameIsRefused) {
  Setting here;
  here.cwd = folder_.path();
  refuse({"run", input(), "--method", "truth", "--out", ""}, "--out: must not be empty", here);
  refuse({"simulate", input(), "-o", ""}, "--out: must not be empty", here);
  refuse({"estimate", "x", "--method", "vgicp", "-o", ""}, "--out: must not be empty", here);
  refuse({"sweep", "x.yaml", "-o", ""}, "--out: must not be empty", here);
  refuse({"inspect", project_file("tests/system/short.plan.yaml"), "--mesh", ""}, "--mesh: must not be empty", here);
  refuse({"run", ""}, "INPUT: must not be empty", here);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Manners, HelpDoesNotHideAWrongCommand) {
  refuse({"bogus", "--help"}, "unknown command 'bogus'");
  refuse({"rnu", "-h"}, "did you mean 'run'?");
  refuse({"generate", "coridor", "--help"}, "did you mean 'corridor'?; see plumbline generate --help");
  for (const std::vector<std::string>& right : std::vector<std::vector<std::string>>{{"--help"},
                                                                                     {"run", "--help"},
                                                                                     {"run", "x.yaml", "--help"},
                                                                                     {"generate", "corridor", "--help"},
                                                                                     {"sweep", "s.yaml", "--help"},
                                                                                     {"sweep", "collect", "--help"}})
    EXPECT_EQ(plumbline(right).code, 0) << right.front();
}

TEST_F(Manners, ATerminalObeysNoName) {
  std::string plan = read_file(project_file("tests/system/short.plan.yaml"));
  const std::string name = R"("a\nb\e[31mRED\a\N\u202e")";  // C0, C1 and a turn of direction
  plan.replace(plan.find("name: short"), 11, "name: " + name);
  for (std::size_t at; (at = plan.find("id: hall,")) != std::string::npos;) plan.replace(at, 9, "id: " + name + ",");
  const std::string path = folder_ / "odd.plan.yaml";
  write_file(path, plan);
  const auto obeyed = [](const std::string& text) {
    const auto control = [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; };
    return std::any_of(text.begin(), text.end(), control) || text.find("\xC2\x85") != std::string::npos ||
           text.find("\xE2\x80\xAE") != std::string::npos;
  };
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{}, {"--json"}}) {
    std::vector<std::string> arguments = {"inspect", path};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plumbline(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_FALSE(obeyed(outcome.out)) << outcome.out;
    EXPECT_NE(outcome.out.find("\\u001b[31mRED\\u0007\\u0085\\u202e"), std::string::npos) << outcome.out;
    if (more.empty()) {
      EXPECT_NE(outcome.out.find("a\\u000ab"), std::string::npos) << outcome.out;
    }
  }
  const Outcome lost = plumbline({"inspect", folder_ / "no\x1b]0;file\x07\xC2\x9B.yaml"});
  EXPECT_EQ(lost.code, 2);
  EXPECT_FALSE(obeyed(lost.err)) << lost.err;
  EXPECT_NE(lost.err.find("no\\u001b]0;file\\u0007\\u009b.yaml: no such file"), std::string::npos) << lost.err;
}

TEST_F(Manners, ASparseFileIsRefusedBeforeItIsRead) {
  Setting little;  // of memory, as a shell limits it: the program alone takes a part of it
  little.wrapper = {"bash", "-c", "ulimit -v 1500000; exec \"$@\"", "-"};
  for (const char* name : {"b.yaml", "b.ifc", "b.glb", "b.tum"}) {
    write_file(folder_ / name, "");
    std::error_code error;
    fs::resize_file(folder_ / name, std::uintmax_t{20} << 30U, error);
    if (error) GTEST_SKIP() << "no file of 20 GB here: " << error.message();
    refuse({"inspect", folder_ / name}, "holds 21474836480 bytes; at most ", little);
    refuse({"run", folder_ / name, "--out", folder_ / "out"}, "holds 21474836480 bytes; at most ", little);
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Manners, AFolderWithAFileThatIsNoneListsTheOtherScenarios) {
  write_file(folder_ / "good.yaml", read_file(input()));
  write_file(folder_ / "broken.yaml", "scenario: [1\n");
  fs::create_directory(folder_ / "folder.yaml");
  const Outcome outcome = plumbline({"scenarios", folder_.path()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.out.find("good.yaml"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("broken.yaml:"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST_F(Manners, ALinkToNothingIsNoPlaceForOutput) {
  fs::create_symlink(folder_ / "nowhere", folder_ / "link");
  refuse({"simulate", input(), "--out", folder_ / "link"}, "link: is a link to '");
  write_file(folder_ / "s.yaml", "sweep: 1\nscenarios: [" + input() + "]\nseeds: 1\nmethods: [odometry]\n");
  refuse({"sweep", folder_ / "s.yaml", "-o", folder_ / "link"}, "link: is a link to '");
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
}

TEST_F(Manners, ASweepSaysWhyItsFolderCannotBeMade) {
  write_file(folder_ / "s.yaml", "sweep: 1\nscenarios: [" + input() + "]\nseeds: 1\nmethods: [odometry]\n");
  write_file(folder_ / "file", "x");
  refuse({"sweep", folder_ / "s.yaml", "-o", folder_ / "file"}, "is a file; --out must name a directory");
  const Outcome below = plumbline({"sweep", folder_ / "s.yaml", "-o", folder_ / "file/out"});
  EXPECT_EQ(below.code, 3);
  EXPECT_NE(below.err.find("cannot be created: Not a directory"), std::string::npos) << below.err;
}

TEST_F(Manners, ASweepSaysWhyTheSystemGivesItNoFolder) {
  if (!fs::exists("/sys/kernel")) GTEST_SKIP() << "no /sys/kernel here";
  write_file(folder_ / "s.yaml", "sweep: 1\nscenarios: [" + input() + "]\nseeds: 1\nmethods: [odometry]\n");
  const Outcome refused = plumbline({"sweep", folder_ / "s.yaml", "-o", "/sys/kernel/plumbline"});  // not even for root
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("/sys/kernel/plumbline: cannot be created: "), std::string::npos) << refused.err;
  EXPECT_EQ(refused.err.find("No such file"), std::string::npos) << refused.err;
}

TEST_F(Manners, WhatIsNoBagIsSaidInWordsAboutBags) {
  const auto complaint = [&](const std::string& name) {
    const Outcome outcome = plumbline({"estimate", folder_ / name, "--method", "vgicp", "-o", folder_ / "out"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(complaint("none.bag").find("none.bag: no such file; "), std::string::npos);
  for (const std::string& content : {std::string(), std::string("hello"), std::string("#ROSBAG V1.2\n")}) {
    write_file(folder_ / "odd.bag", content);
    EXPECT_NE(complaint("odd.bag").find("odd.bag: is no ROS 1 bag"), std::string::npos);
    EXPECT_EQ(complaint("odd.bag").find("pcap"), std::string::npos);
  }
  for (const char* name : {"0.bin", "0.pcd"}) {
    write_file(folder_ / name, "0123456789abcdef");
    EXPECT_NE(complaint(name).find("is one scan; give the folder"), std::string::npos);
  }
  // A record says that it has 2 GB.
  write_file(folder_ / "long.bag", "#ROSBAG V2.0\n" + std::string(60, 'x'));
  Setting little;
  little.wrapper = {"bash", "-c", "ulimit -v 1500000; exec \"$@\"", "-"};
  refuse({"estimate", folder_ / "long.bag", "--method", "vgicp", "-o", folder_ / "out"}, "byte 13: a length of ",
         little);
}

TEST_F(Manners, TrajectoriesOfOtherFormsGetTheSameScores) {
  const std::string run = folder_ / "run";
  ASSERT_EQ(plumbline({"run", input(), "--method", "odometry", "--out", run}).code, 0);
  const std::string tum = run + "/odometry.tum";
  std::string kitti, euroc = "#timestamp,px,py,pz,qw,qx,qy,qz\n";
  for (const slam::StampedPose& pose : slam::read_tum(read_text_file(tum), tum)) {
    const Eigen::Matrix3d R = pose.X_FR.q.toRotationMatrix();
    const Eigen::Vector3d& t = pose.X_FR.t;
    char line[400];
    std::snprintf(line, sizeof(line), "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  R(0, 0), R(0, 1), R(0, 2), t.x(), R(1, 0), R(1, 1), R(1, 2), t.y(), R(2, 0), R(2, 1), R(2, 2), t.z());
    kitti += line;
    const Eigen::Quaterniond& q = pose.X_FR.q;
    std::snprintf(line, sizeof(line), "%lld,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                  static_cast<long long>(pose.stamp), t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
    euroc += line;
  }
  write_file(folder_ / "kitti.txt", kitti);
  write_file(folder_ / "euroc.csv", euroc);
  const Outcome scored = plumbline({"score", run, "--estimate", "k=" + (folder_ / "kitti.txt"), "--estimate",
                                    "e=" + (folder_ / "euroc.csv"), "--estimate", "t=" + tum});
  ASSERT_EQ(scored.code, 0) << scored.err;
  const auto methods = nlohmann::json::parse(read_file(run + "/results.json"))["methods"];
  for (const char* metric : {"ate_rmse_m", "ate_aligned_rmse_m", "rpe_1m_rmse_m"})
    for (const char* name : {"k", "e"})
      EXPECT_NEAR(methods[name][metric].get<double>(), methods["t"][metric].get<double>(), 1e-9) << name << metric;
  write_file(folder_ / "short.txt", kitti.substr(kitti.find('\n') + 1));
  refuse({"score", run, "--estimate", "s=" + (folder_ / "short.txt")}, "poses in KITTI form, which has no times");
}

TEST_F(Manners, OutsideEstimatesAreAskedTheirOwnGates) {
  const std::string run = folder_ / "run";
  ASSERT_EQ(plumbline({"run", input(), "--method", "odometry", "--out", run}).code, 0);
  const std::string given = "mine=" + run + "/odometry.tum", map = "mine=" + run + "/odometry.map.ply";
  const auto results = [&] { return nlohmann::json::parse(read_file(run + "/results.json")); };

  const Outcome failed = plumbline({"score", run, "--estimate", given, "--gate", "ate_aligned_rmse_m <= 1e-9"});
  EXPECT_EQ(failed.code, 1) << failed.err;
  EXPECT_NE(failed.out.find("mine is asked by --gate: ate_aligned_rmse_m <= "), std::string::npos) << failed.out;
  EXPECT_FALSE(results()["methods"]["mine"].contains("map_rmse_m"));
  // They stay with the estimate.
  ASSERT_EQ(plumbline({"report", run}).code, 0);
  EXPECT_EQ(plumbline({"score", run}).code, 1);

  const Outcome passed = plumbline({"score", run, "--estimate", given, "--map", map, "--gate", "ate_aligned_rmse_m<=5",
                                    "--gate", "map_rmse_m<=0.5", "--gate", "map_completeness>=0.01"});
  EXPECT_EQ(passed.code, 0) << passed.out << passed.err;
  const auto methods = results()["methods"];
  EXPECT_EQ(methods["mine"]["map_rmse_m"], methods["odometry"]["map_rmse_m"]);
  EXPECT_EQ(results()["gates"].size(), 3);
  EXPECT_EQ(plumbline({"score", run, "--estimate", given, "--gate", "map_rmse_m<=0.5"}).code, 1);  // it has no map now

  refuse({"score", run, "--gate", "ate_rmse_m<=1"}, "give them with --estimate");
  refuse({"score", run, "--estimate", given, "--gate", "ate_rmse_m=1"}, "must be METRIC<=X");
  refuse({"score", run, "--estimate", given, "--gate", "ate_rmse_m<=1m"}, "must be a number");
  refuse({"score", run, "--estimate", given, "--gate", "ate_rmse<=1"}, "did you mean 'ate_rmse_m'?");
  refuse({"score", run, "--estimate", given, "--map", "other=" + run + "/odometry.map.ply"}, "no --estimate 'other'");
  refuse({"score", run, "--estimate", given, "--map", given}, "odometry.tum");
}

}  // namespace
}  // namespace plumbline::system_tests
