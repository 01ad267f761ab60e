// SPDX-License-Identifier: Apache-2.0
// Recordings: what estimate says of one is what run said in process; what is no recording is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/data.h"
#include "tests/slam/io/packets/foreign_capture.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

std::string input() { return project_file("tests/system/emulated.yaml"); }
std::string plan() { return project_file("tests/system/short.plan.yaml"); }

class Recordings : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }

  /// Every file estimate wrote about a method has the bytes that run wrote.
  void expect_same(const std::string& recording, const std::string& run, const std::string& method) {
    const std::string out = folder_ / ("out_" + method);
    std::vector<std::string> line = {"estimate", recording, "--method", method, "-o", out};
    if (method.starts_with("s_graph_localization")) line.insert(line.end(), {"--plan", plan()});
    const Outcome outcome = plumbline(line);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    int compared = 0;
    for (const char* end :
         {".tum", ".final.tum", ".estimate.json", ".map.ply", ".map.pcd", ".graph.json", ".hypotheses.jsonl"}) {
      ASSERT_EQ(fs::exists(out + "/" + method + end), fs::exists(run + "/" + method + end)) << method << end;
      if (!fs::exists(out + "/" + method + end)) continue;
      EXPECT_TRUE(read_file(out + "/" + method + end) == read_file(run + "/" + method + end)) << method << end;
      ++compared;
    }
    EXPECT_GE(compared, 4);
  }

  /// Expects estimate to refuse: exit 2, one line that starts with `where` and holds `what`, nothing written.
  void refuse(const std::vector<std::string>& arguments, const std::string& where, const std::string& what) {
    std::vector<std::string> all = {"estimate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"-o", folder_ / "refused"});
    const Outcome outcome = plumbline(all);
    EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.err.rfind(where, 0), 0U) << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "refused"));
  }

  /// Estimates a capture of 293 packets by itself: three poses, from the second at which it was captured on.
  void expect_three_poses(const std::string& capture, const std::string& second) {
    for (const char* method : {"vgicp", "s_graphs_plus"}) {
      const Outcome outcome = plumbline({"estimate", capture, "--method", method, "-o", folder_ / method});
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      const std::string poses = read_file(folder_ / (std::string(method) + "/" + method + ".tum"));
      EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 3) << method;
      EXPECT_EQ(poses.rfind(second, 0), 0U) << poses;
    }
  }

  /// A recording of a second, made on first use; the path of its copy under this name.
  std::string walk(const std::string& name) {
    const std::string made = folder_ / "made";
    if (!fs::exists(made)) {
      std::string scenario = read_file(input());
      scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 1");
      write_file(folder_ / "second.yaml", scenario);
      write_file(folder_ / "short.plan.yaml", read_file(plan()));
      EXPECT_EQ(plumbline({"simulate", folder_ / "second.yaml", "-o", made, "--bag"}).code, 0);
    }
    fs::copy(made, folder_ / name, fs::copy_options::recursive);
    return folder_ / name;
  }

  static void cut(const std::string& file, double share) {
    fs::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(file))));
  }

  Folder folder_;
};

TEST_F(Recordings, WhatIsNoRecordingIsRefused) {
  refuse({folder_ / "none", "--method", "vgicp"}, folder_ / "none", "no such file");
  refuse({folder_.path(), "--method", "vgicp"}, folder_.path(), "no lidar.pcap");
  refuse({plan(), "--method", "vgicp"}, plan(), "no pcap capture");
  const std::string good = walk("good");
  refuse({good, "--method", "vgcip"}, "--method", "'vgicp'");
  refuse({good, "--method", "truth"}, "--method", "no estimator");
  refuse({good, "--method", "s_graph_localization"}, "--plan", "is missing");
  refuse({good, "--method", "s_graph_localization", "--plan", plan(), "--storey", "attic"}, "--storey", "ground");
  refuse({good, "--method", "vgicp", "--plan", plan()}, "--plan", "'vgicp' does not");
  refuse({good, "--method", "vgicp", "--storey", "ground"}, "--storey", "'vgicp' does not");
  refuse({good, "--method", "vgicp", "--plan-furniture", "none"}, "--plan-furniture", "'vgicp' does not");
  refuse({good, "--method", "odometry", "--yaw-deg", "0"}, "--yaw-deg", "'odometry' does not");
  refuse({good + "/lidar.pcap", "--method", "odometry"}, good, "holds no odometry");
  const std::string text = read_file(plan()), roomless = folder_ / "roomless.plan.yaml";
  const std::size_t rooms = text.find("rooms:"), after = text.find("materials:");
  ASSERT_LT(rooms, after);
  write_file(roomless, text.substr(0, rooms) + text.substr(after));
  refuse({good, "--method", "s_graph_localization", "--plan", roomless}, roomless, "add rooms");
}

TEST_F(Recordings, AMethodIsToldOfFurnitureWhatTheRunToldIt) {
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  write_file(folder_ / "told.yaml", read_file(input()) +
                                        "furnish: {density: 0.1, seed: 2}\nplan: {furniture: none}\n"
                                        "world: {furniture: moved}\n");
  const std::string run = folder_ / "run";
  ASSERT_EQ(plumbline({"run", folder_ / "told.yaml", "--method", "s_graph_localization", "--record", "-o", run}).code,
            0);
  expect_same(run, run, "s_graph_localization");
}

TEST_F(Recordings, DamagedOnesAreRefusedWhole) {
  const std::string dir = walk("bad"), pcap = dir + "/lidar.pcap", bag = dir + "/recording.bag";
  const std::string packets = read_file(pcap);
  cut(pcap, 0.7);
  refuse({dir, "--method", "vgicp"}, pcap, "truncated");
  write_file(pcap, packets.substr(0, 24));
  refuse({dir, "--method", "vgicp"}, pcap, "no Velodyne data packets");
  std::string ports = packets;
  for (std::size_t at = 0; (at = ports.find("\x09\x40\x09\x40", at)) != std::string::npos;)
    ports.replace(at, 4, "\x09\x41\x09\x41");
  write_file(pcap, ports);
  refuse({dir, "--method", "vgicp"}, pcap, "there is traffic to port 2369");
  std::string product = packets;
  product[packets.size() - 1] = '\x77';
  write_file(pcap, product);
  refuse({dir, "--method", "vgicp"}, pcap, "product");
  write_file(pcap, packets);
  write_file(dir + "/odometry.tum", "0.5 0 0 0 0 0 0 1\n0.25 0 0 0 0 0 0 1\n");
  refuse({dir, "--method", "vgicp"}, dir + "/odometry.tum:2:1", "stamps must increase");
  cut(bag, 0.6);
  refuse({bag, "--method", "vgicp"}, bag, "");
}

TEST_F(Recordings, ABagGivesWhatThePacketsGiveUpToItsFloats) {
  const std::string dir = walk("walk");
  ASSERT_EQ(plumbline({"estimate", dir, "--method", "odometry", "-o", folder_ / "a"}).code, 0);
  ASSERT_EQ(plumbline({"estimate", dir + "/recording.bag", "--method", "odometry", "-o", folder_ / "b"}).code, 0);
  std::istringstream a(read_file(folder_ / "a/odometry.tum")), b(read_file(folder_ / "b/odometry.tum"));
  int numbers = 0;
  for (double x = 0, y = 0; a >> x && b >> y; ++numbers)
    EXPECT_NEAR(x, y, 1e-7);  // poses at the scans' stamps, which a bag holds to 8 ns, at 0.6 m/s
  EXPECT_GE(numbers, 8 * 9);
}

TEST_F(Recordings, ValuesOfAMethodAreReadShownAndChecked) {
  const std::string dir = walk("walk");
  const Outcome page = plumbline({"methods", "--config", "vgicp", "--all"});
  ASSERT_EQ(page.code, 0);
  write_file(folder_ / "all.yaml", page.out);
  write_file(folder_ / "some.yaml", "odometry: {map_voxel_m: 0.75}\n");
  ASSERT_EQ(plumbline({"estimate", dir, "--method", "vgicp", "-o", folder_ / "plain"}).code, 0);
  ASSERT_EQ(
      plumbline({"estimate", dir, "--method", "vgicp", "--config", folder_ / "all.yaml", "-o", folder_ / "all"}).code,
      0);
  ASSERT_EQ(
      plumbline({"estimate", dir, "--method", "vgicp", "--config", folder_ / "some.yaml", "-o", folder_ / "some"}).code,
      0);
  EXPECT_TRUE(read_file(folder_ / "all/vgicp.tum") == read_file(folder_ / "plain/vgicp.tum"));
  EXPECT_TRUE(read_file(folder_ / "all/estimate.yaml") == read_file(folder_ / "plain/estimate.yaml"));
  EXPECT_FALSE(read_file(folder_ / "some/vgicp.tum") == read_file(folder_ / "plain/vgicp.tum"));
  EXPECT_NE(read_file(folder_ / "some/estimate.yaml").find("map_voxel_m: 0.75"), std::string::npos);
  write_file(folder_ / "bad.yaml", "odometry: {map_vxel_m: 0.75}\n");
  refuse({dir, "--method", "vgicp", "--config", folder_ / "bad.yaml"}, folder_ / "bad.yaml", "'map_voxel_m'");
  write_file(folder_ / "bad.yaml", "odometry: {map_voxel_m: -1}\n");
  refuse({dir, "--method", "vgicp", "--config", folder_ / "bad.yaml"}, folder_ / "bad.yaml", "at least");
}

TEST_F(Recordings, ACaptureOfARealSensorNeedsNothingElse) {
  const std::string name = "vlp16/sample_velodyne_vlp16_gps.pcap";
  if (const std::string why = data_missing(name); !why.empty()) GTEST_SKIP() << why;
  expect_three_poses(data_path(name), "1453364282.");
}

TEST_F(Recordings, ACaptureOfAnotherProgramNeedsNothingElse) {
  write_file(folder_ / "hall.pcap", slam::foreign_capture(293));
  expect_three_poses(folder_ / "hall.pcap", "946684800.");
  for (const char* method : {"vgicp", "s_graphs_plus"}) {  // it stands still
    std::istringstream poses(read_file(folder_ / (std::string(method) + "/" + method + ".tum")));
    for (std::string line; std::getline(poses, line);) {
      std::istringstream words(line);
      double stamp = 0, x = 1, y = 1;
      words >> stamp >> x >> y;
      EXPECT_LT(std::hypot(x, y), 0.01) << method << ": " << line;  // ranges are whole multiples of 2 mm
    }
  }
}

TEST_F(Recordings, NoEstimateReplacesTheRecordingItIsOf) {
  const std::string recording = walk("kept");
  const std::string packets = read_file(recording + "/lidar.pcap");
  const Outcome refused = plumbline({"estimate", recording, "--method", "odometry", "-o", recording, "--force"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("which no estimate writes; name another --out"), std::string::npos) << refused.err;
  EXPECT_TRUE(read_file(recording + "/lidar.pcap") == packets);
  const std::string out = folder_ / "estimate";
  ASSERT_EQ(plumbline({"estimate", recording, "--method", "odometry", "-o", out}).code, 0);
  EXPECT_EQ(plumbline({"estimate", recording, "--method", "odometry", "-o", out}).code, 2);
  EXPECT_EQ(plumbline({"estimate", recording, "--method", "odometry", "-o", out, "--force"}).code, 0);
}

// Carried off, the sensors say nothing for a while; the recording is one all the same.
TEST_F(Recordings, AKidnappingIsEstimatedAsItRan) {
  std::string scenario = read_file(input());
  scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 8");
  write_file(folder_ / "away.yaml", scenario + "kidnap: {after_s: 2, to: {room: right}, away_s: 3}\n");
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string run = folder_ / "run";
  ASSERT_EQ(
      plumbline({"run", folder_ / "away.yaml", "--out", run, "--record", "--method", "vgicp,s_graph_localization"})
          .code,
      0);
  for (const char* method : {"vgicp", "s_graph_localization"}) expect_same(run, run, method);
}

// What the sensors do wrong is in their records; the mount is the one that methods are told.
TEST_F(Recordings, AHarshWalkIsEstimatedAsItRan) {
  for (const char* offset : {"0.03", "-0.03"}) {
    write_file(folder_ / "harsh.yaml", read_file(input()) +
                                           "lidar: {preset: harsh}\nfaults: {preset: harsh, clock_offset_s: " +
                                           std::string(offset) + ", mount_offset_m: [0.01, 0.02, 0]}\n");
    write_file(folder_ / "short.plan.yaml", read_file(plan()));
    const std::string run = folder_ / ("run" + std::string(offset));
    ASSERT_EQ(
        plumbline({"run", folder_ / "harsh.yaml", "--out", run, "--record", "--method", "vgicp,s_graphs_plus"}).code,
        0);
    const std::string info = read_file(run + "/recording/recording.yaml");
    EXPECT_NE(info.find("0.01"), std::string::npos) << info;
    EXPECT_EQ(info.find("faults"), std::string::npos) << info;
    for (const char* method : {"vgicp", "s_graphs_plus"}) {
      expect_same(run, run, method);
      fs::remove_all(folder_ / (std::string("out_") + method));
    }
  }
}

TEST_F(Recordings, EstimateSaysWhatRunSaid) {
  write_file(folder_ / "open.yaml", read_file(input()) + "doors: open\n");  // that of the closet too
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string open = folder_ / "open.yaml", run = folder_ / "run";
  const std::string methods = "odometry,vgicp,s_graphs_plus,s_graph_localization";
  ASSERT_EQ(plumbline({"run", open, "--out", run, "--record", "--method", methods}).code, 0);
  const std::string walk = folder_ / "walk";
  ASSERT_EQ(plumbline({"simulate", open, "-o", walk}).code, 0);
  for (const char* name : {"lidar.pcap", "odometry.tum", "odometry_covariance.csv", "imu.csv", "recording.yaml"})
    EXPECT_TRUE(read_file(walk + "/" + name) == read_file(run + "/recording/" + name)) << name;
  EXPECT_TRUE(read_file(walk + "/truth.tum") == read_file(run + "/truth.tum"));

  for (const char* name : {"truth.tum", "scenario.yaml", "building.plan.yaml"}) fs::remove(walk + "/" + name);
  for (const char* method : {"odometry", "vgicp", "s_graphs_plus", "s_graph_localization"})
    expect_same(walk, run, method);

  // An estimate's directory is scored whole: map, walls and rooms beside the trajectory.
  const Outcome scored = plumbline({"score", run, "--estimate", "again=" + (folder_ / "out_s_graphs_plus"),
                                    "--estimate", "there=" + (folder_ / "out_s_graph_localization")});
  EXPECT_EQ(scored.code, 0) << scored.err;
  const auto results = nlohmann::json::parse(read_file(run + "/results.json"));
  EXPECT_EQ(results["methods"]["again"], results["methods"]["s_graphs_plus"]);
  EXPECT_EQ(results["methods"]["there"], results["methods"]["s_graph_localization"]);
  EXPECT_TRUE(results["methods"]["again"].contains("rooms"));
  const auto timings = nlohmann::json::parse(read_file(folder_ / "out_s_graphs_plus/timings.json"));
  EXPECT_TRUE(timings["stages"].contains("s_graphs_plus/plane_segmentation"));
  EXPECT_EQ(timings["stages"]["s_graphs_plus/finish"]["count"], 1);
  // The time of the recording, whether or not the method knew where it was.
  const auto localized = nlohmann::json::parse(read_file(folder_ / "out_s_graph_localization/timings.json"));
  EXPECT_EQ(localized["simulated_s"], timings["simulated_s"]);
  EXPECT_GT(timings["simulated_s"], 4.0);
  const Outcome refused = plumbline({"score", run, "--estimate", "walk=" + walk});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("holds no estimate"), std::string::npos) << refused.err;
}

TEST_F(Recordings, LidarAloneIsAnEstimateOfItsOwn) {
  write_file(folder_ / "both.yaml", read_file(input()) + "sensors: [all, lidar]\n");
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string run = folder_ / "run", alone = folder_ / "alone", without = folder_ / "without";
  ASSERT_EQ(plumbline({"run", folder_ / "both.yaml", "--out", run, "--record", "--method", "vgicp,odometry"}).code, 0);
  EXPECT_TRUE(fs::exists(run + "/odometry.tum"));
  EXPECT_FALSE(fs::exists(run + "/odometry.lidar.tum")) << "it needs odometry";
  EXPECT_FALSE(read_file(run + "/vgicp.tum") == read_file(run + "/vgicp.lidar.tum"));
  EXPECT_TRUE(nlohmann::json::parse(read_file(run + "/results.json"))["methods"].contains("vgicp.lidar"));
  EXPECT_NE(read_file(run + "/report.html").find("vgicp.lidar"), std::string::npos);
  EXPECT_EQ(plumbline({"replay", run}).out.rfind("equal: ", 0), 0U);

  // The same by --sensors, by the label, and of a recording that has nothing else.
  ASSERT_EQ(plumbline({"estimate", run, "--method", "vgicp", "--sensors", "lidar", "-o", alone}).code, 0);
  EXPECT_NE(read_file(alone + "/estimate.yaml").find("sensors: lidar"), std::string::npos);
  ASSERT_EQ(plumbline({"estimate", run, "--method", "vgicp.lidar", "-o", without}).code, 0);
  for (const char* end : {".tum", ".final.tum", ".estimate.json", ".map.ply"}) {
    const std::string name = std::string("/vgicp.lidar") + end;
    EXPECT_TRUE(read_file(alone + name) == read_file(run + name)) << name;
    EXPECT_TRUE(read_file(without + name) == read_file(run + name)) << name;
  }
  ASSERT_EQ(plumbline({"estimate", run, "--method", "vgicp", "-o", folder_ / "with"}).code, 0);
  EXPECT_EQ(plumbline({"diff", folder_ / "with", alone}).code, 1);
  refuse({run, "--method", "odometry", "--sensors", "lidar"}, "--method", "needs odometry");
  refuse({run, "--method", "vgicp.lidar", "--sensors", "all"}, "--sensors", "give one of them");
  EXPECT_EQ(plumbline({"score", run, "--estimate", "copy.lidar=" + alone}).code, 0);
  EXPECT_EQ(plumbline({"score", run, "--estimate", "a.final=" + alone}).code, 2);
}

TEST_F(Recordings, EveryNthScanAndPlainerScansAreEstimatesOfTheSameWalk) {
  const std::string walk = this->walk("walk"), whole = folder_ / "whole", poor = folder_ / "poor";
  const auto lines = [](const std::string& file) {
    std::istringstream in(read_file(file));
    std::vector<std::string> stamps;
    for (std::string line; std::getline(in, line);) stamps.push_back(line.substr(0, line.find(' ')));
    return stamps;
  };
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "-o", whole}).code, 0);
  EXPECT_EQ(read_file(whole + "/estimate.yaml").find("every"), std::string::npos);
  const Outcome outcome =
      plumbline({"estimate", walk, "--method", "vgicp", "--every", "4", "--without", "rings,times", "-o", poor});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string said = read_file(poor + "/estimate.yaml");
  EXPECT_NE(said.find("every: 4"), std::string::npos) << said;
  for (const char* word : {"without:", "rings", "times"}) EXPECT_NE(said.find(word), std::string::npos) << said;
  const auto all = lines(whole + "/vgicp.tum"), some = lines(poor + "/vgicp.tum");
  ASSERT_EQ(some.size(), (all.size() + 3) / 4);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], all[4 * i]);
  ASSERT_EQ(plumbline({"score", poor, "--reference", walk + "/truth.tum"}).code, 0);
  EXPECT_EQ(nlohmann::json::parse(read_file(poor + "/score.json"))["silence"]["silent_s"], 0.0);
  refuse({walk, "--method", "vgicp", "--every", "0"}, "plumbline: --every", "estimate --help");
  refuse({walk, "--method", "vgicp", "--without", "points"}, "plumbline: --without", "estimate --help");
}

TEST_F(Recordings, ALidarThatSendsNoPacketsIsRecordedAsABag) {
  std::string scenario = read_file(input());
  scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 1\nlidar: {model: os1_64}");
  write_file(folder_ / "os1.yaml", scenario);
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string walk = folder_ / "walk", out = folder_ / "out";
  const Outcome refused = plumbline({"simulate", folder_ / "os1.yaml", "-o", walk});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--bag"), std::string::npos) << refused.err;
  ASSERT_EQ(plumbline({"simulate", folder_ / "os1.yaml", "-o", walk, "--bag"}).code, 0);
  EXPECT_FALSE(fs::exists(walk + "/lidar.pcap"));
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "-o", out}).code, 0);
  EXPECT_NE(read_file(out + "/estimate.yaml").find("walk:"), std::string::npos);
  ASSERT_EQ(plumbline({"score", out, "--reference", walk + "/truth.tum"}).code, 0);
  EXPECT_LT(nlohmann::json::parse(read_file(out + "/score.json"))["causal"]["ate_aligned_rmse_m"], 0.1);
}

TEST_F(Recordings, AnEstimateWithoutARunIsScoredByAReference) {
  const std::string walk = this->walk("walk"), out = folder_ / "out";
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "-o", out}).code, 0);
  const auto scores = [&] { return nlohmann::json::parse(read_file(out + "/score.json")); };
  ASSERT_EQ(plumbline({"score", out}).code, 0);
  EXPECT_EQ(scores()["lost_share"], 0.0);
  EXPECT_FALSE(scores().contains("reference"));
  EXPECT_FALSE(scores()["causal"].contains("ate_aligned_rmse_m"));

  const Outcome perfect = plumbline({"score", out, "--reference", out + "/vgicp.tum"});
  ASSERT_EQ(perfect.code, 0) << perfect.err;
  EXPECT_EQ(scores()["causal"]["matched"], scores()["causal"]["poses"]);
  EXPECT_LT(scores()["causal"]["ate_aligned_rmse_m"], 1e-12);
  ASSERT_EQ(plumbline({"score", out, "--reference", walk + "/truth.tum"}).code, 0);
  EXPECT_GT(scores()["causal"]["ate_aligned_rmse_m"], 0.0);
  EXPECT_LT(scores()["causal"]["ate_aligned_rmse_m"], 0.1);  // half a metre walked

  const std::string kept = read_file(out + "/score.json");
  const auto refused = [&](const std::vector<std::string>& line, const std::string& what) {
    const Outcome outcome = plumbline(line);
    EXPECT_EQ(outcome.code, 2) << what;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_TRUE(read_file(out + "/score.json") == kept);
  };
  write_file(folder_ / "later.tum", "1000 0 0 0 0 0 0 1\n1001 1 0 0 0 0 0 1\n1002 2 0 0 0 0 0 1\n");
  refused({"score", out, "--reference", folder_ / "later.tum"}, "it is of 1000.000000000 to 1002.000000000 s");
  write_file(folder_ / "empty.tum", "# nothing\n");
  refused({"score", out, "--reference", folder_ / "empty.tum"}, "holds no pose");
  refused({"score", out, "--estimate", "a=" + out}, "is an estimate");
  refused({"score", walk, "--reference", walk + "/truth.tum"}, "--reference");
}

TEST_F(Recordings, AnEstimateOfAnotherRunsRecordingIsNotScored) {
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  write_file(folder_ / "short.yaml", read_file(input()));
  const std::string run = folder_ / "run", other = folder_ / "other", out = folder_ / "out";
  ASSERT_EQ(plumbline({"run", folder_ / "short.yaml", "--out", run, "--method", "odometry"}).code, 0);
  ASSERT_EQ(plumbline({"simulate", folder_ / "short.yaml", "-o", other, "--seed", "2"}).code, 0);
  ASSERT_EQ(plumbline({"estimate", other, "--method", "odometry", "-o", out}).code, 0);
  const std::string results = read_file(run + "/results.json");
  const Outcome refused = plumbline({"score", run, "--estimate", "legs=" + out});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("of another run's recording"), std::string::npos) << refused.err;
  EXPECT_TRUE(read_file(run + "/results.json") == results);
}

}  // namespace
}  // namespace plumbline::system_tests
