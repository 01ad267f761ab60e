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
#include "tests/system/recordings.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

TEST_F(Recordings, WhatIsNoRecordingIsRefused) {
  refuse({folder_ / "none", "--method", "vgicp"}, folder_ / "none", "no such file");
  refuse({folder_.path(), "--method", "vgicp"}, folder_.path(), "no lidar.pcap");
  refuse({plan(), "--method", "vgicp"}, plan(), "no pcap capture");
  const std::string good = walk("good");
  refuse({good, "--method", "vgcip"}, "--method", "'vgicp'");
  refuse({good, "--method", "truth"}, "--method", "no estimator");
  refuse({good, "--method", "s_graph_localization"}, "--plan", "is required");
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

TEST_F(Recordings, ACaptureWithFilesOfItsMotionIsTheRecording) {
  const std::string dir = walk("beside"), pcap = dir + "/lidar.pcap", tum = dir + "/odometry.tum";
  fs::remove(dir + "/odometry_covariance.csv");
  const auto estimate = [&](std::vector<std::string> arguments, const std::string& out) {
    arguments.insert(arguments.begin(), "estimate");
    arguments.insert(arguments.end(), {"--method", "s_graphs_plus", "--unchecked", "-o", folder_ / out});
    return plumbline(arguments);
  };
  ASSERT_EQ(estimate({dir}, "whole").code, 0);
  const Outcome parts =
      estimate({pcap, "--description", dir + "/recording.yaml", "--odometry", tum, "--imu", dir + "/imu.csv"}, "parts");
  ASSERT_EQ(parts.code, 0) << parts.err;
  EXPECT_NE(parts.out.find("odometry odometry.tum; IMU imu.csv"), std::string::npos) << parts.out;
  EXPECT_EQ(read_file(folder_ / "parts/s_graphs_plus.tum"), read_file(folder_ / "whole/s_graphs_plus.tum"));
  refuse({dir, "--method", "vgicp", "--unchecked", "--odometry", tum}, tum, "odometry of its own");
  refuse({pcap, "--method", "vgicp", "--imu", tum}, tum, "no line of an IMU");
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
  const Outcome other = plumbline({"estimate", dir, "--method", "odometry", "-o", folder_ / "other"});
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_NE(other.err.find("those to port 2369 are read"), std::string::npos) << other.err;
  std::string product = packets;
  product[packets.size() - 1] = '\x77';
  write_file(pcap, product);
  refuse({dir, "--method", "vgicp"}, pcap, "product");
  write_file(pcap, packets);
  write_file(dir + "/odometry.tum", "0.5 0 0 0 0 0 0 1\n0.25 0 0 0 0 0 0 1\n");
  refuse({dir, "--method", "vgicp"}, dir + "/odometry.tum:2:1", "stamps must increase");
  cut(bag, 0.6);
  const Outcome some = plumbline({"estimate", bag, "--method", "vgicp", "-o", folder_ / "some"});
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_NE(some.err.find(bag + ": the bag was not closed or is cut off; its last "), std::string::npos) << some.err;
  cut(bag, 0.01);
  refuse({bag, "--method", "vgicp"}, bag, "without a whole message");
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

  EXPECT_EQ(plumbline({"score", out, "--gate", "ate_aligned_rmse_m<=1"}).code, 1);  // absent without a reference
  const std::vector<std::string> scored = {"score", out, "--reference", walk + "/truth.tum", "--gate"};
  const auto with_gate = [&](const std::string& gate) {
    std::vector<std::string> line = scored;
    line.push_back(gate);
    return plumbline(line);
  };
  EXPECT_EQ(with_gate("final.ate_aligned_rmse_m<=0.1").code, 0);
  EXPECT_EQ(with_gate("lost_share<=0").code, 0);
  EXPECT_EQ(with_gate("coverage>=0.99").code, 0);
  const Outcome missed = with_gate("ate_aligned_rmse_m<=1e-9");
  EXPECT_EQ(missed.code, 1);
  EXPECT_NE(missed.out.find("FAILED: ate_aligned_rmse_m of vgicp is "), std::string::npos) << missed.out;
  EXPECT_EQ(scores()["gates"][0]["passed"], false);

  // A reference of half the walk, and an estimate of half the scans.
  const auto first_half = [](const std::string& text) {
    std::string half;
    for (long left = std::count(text.begin(), text.end(), '\n') / 2; left > 0; --left)
      half += text.substr(half.size(), text.find('\n', half.size()) + 1 - half.size());
    return half;
  };
  const std::string whole = read_file(out + "/vgicp.tum");
  write_file(folder_ / "half.tum", "\xEF\xBB\xBF" + first_half(read_file(walk + "/truth.tum")));
  const Outcome half =
      plumbline({"score", out, "--reference", folder_ / "half.tum", "--gate", "ate_aligned_rmse_m<=1"});
  EXPECT_EQ(half.code, 1) << half.err;
  EXPECT_NE(half.out.find(", but the reference covers 5"), std::string::npos) << half.out;
  // A method that was silent after its first pose covers no more for it.
  std::string gap = whole;
  const std::size_t second = gap.find('\n') + 1;
  gap.erase(second, gap.find('\n', second) + 1 - second);
  write_file(out + "/vgicp.tum", gap);
  const Outcome silent = plumbline({"score", out, "--reference", folder_ / "half.tum", "--unchecked"});
  ASSERT_EQ(silent.code, 0) << silent.err;
  EXPECT_NEAR(scores()["reference"]["share"].get<double>(), 0.5, 0.05);
  write_file(out + "/vgicp.tum", first_half(whole));
  const Outcome lost = plumbline({"score", out, "--reference", walk + "/truth.tum", "--unchecked", "--gate",
                                  "ate_aligned_rmse_m<=1", "--gate", "lost_share<=0", "--gate", "coverage>=0.1"});
  EXPECT_EQ(lost.code, 1) << lost.err;
  EXPECT_NE(lost.out.find("must be <= 1, but "), std::string::npos) << lost.out;
  EXPECT_NE(lost.out.find(" scans have a pose"), std::string::npos) << lost.out;
  EXPECT_NE(lost.out.find("passed: lost_share"), std::string::npos) << lost.out;
  EXPECT_NE(lost.out.find("passed: coverage"), std::string::npos) << lost.out;
  fs::remove(out + "/vgicp.final.tum");
  write_file(out + "/vgicp.tum", whole);
  const Outcome missing = plumbline({"score", out});
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("missing: vgicp.final.tum"), std::string::npos) << missing.err;
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "-o", out, "--force"}).code, 0);
  ASSERT_EQ(plumbline({"score", out}).code, 0);

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
  refused({"score", out, "--gate", "ate_aligned_rmse<=1"}, "did you mean 'ate_aligned_rmse_m'?");
  refused({"score", walk, "--reference", walk + "/truth.tum"}, "--reference");
}

// A number of the odometry, and then the poses of the estimate.
TEST_F(Recordings, AlteredOnesAreTakenOnlyUnchecked) {
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  write_file(folder_ / "short.yaml", read_file(input()));
  const std::string run = folder_ / "run", walk = run + "/recording", out = folder_ / "out";
  ASSERT_EQ(plumbline({"run", folder_ / "short.yaml", "--record", "--out", run, "--method", "vgicp"}).code, 0);
  const auto estimated = [&](const std::string& recording, const std::string& option) {
    std::vector<std::string> words = {"estimate", recording, "--method", "odometry", "-o", out, "--force"};
    if (!option.empty()) words.push_back(option);
    return plumbline(words);
  };
  ASSERT_EQ(estimated(walk, "").code, 0);
  const std::string text = read_file(walk + "/odometry.tum");
  write_file(walk + "/odometry.tum", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  for (const std::string& given : {walk, run}) {
    const Outcome refused = estimated(given, "");
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("altered since they were written: odometry.tum;"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(estimated(walk, "--unchecked").code, 0);
  EXPECT_NE(read_file(out + "/estimate.yaml").find("unchecked:"), std::string::npos);
  fs::remove(walk + "/manifest.csv");
  fs::remove(run + "/manifest.csv");
  EXPECT_EQ(estimated(walk, "").code, 0);  // as one from elsewhere
  write_file(walk + "/odometry.tum", text);

  const auto scored = [&](const std::string& option) {
    std::vector<std::string> words = {"score", run, "--estimate", "legs=" + out};
    if (!option.empty()) words.push_back(option);
    return plumbline(words);
  };
  ASSERT_EQ(plumbline({"run", folder_ / "short.yaml", "--out", run, "--method", "vgicp", "--force"}).code, 0);
  ASSERT_EQ(plumbline({"simulate", folder_ / "short.yaml", "-o", folder_ / "again"}).code, 0);
  ASSERT_EQ(estimated(folder_ / "again", "").code, 0);
  ASSERT_EQ(scored("").code, 0);
  fs::copy_file(run + "/truth.tum", out + "/odometry.tum", fs::copy_options::overwrite_existing);
  const Outcome refused = scored("");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find(out + ": altered since they were written: odometry.tum;"), std::string::npos)
      << refused.err;
  const Outcome taken = scored("--unchecked");
  EXPECT_EQ(taken.code, 0) << taken.err;
  const auto unchecked = [&] { return nlohmann::json::parse(read_file(run + "/results.json"))["unchecked"]; };
  EXPECT_EQ(unchecked(), nlohmann::json::array({"legs=odometry.tum"}));
  ASSERT_EQ(plumbline({"score", run}).code, 0);
  EXPECT_EQ(unchecked(), nlohmann::json::array({"legs=odometry.tum"}));  // it stays so
  ASSERT_EQ(plumbline({"score", run, "--drop", "legs"}).code, 0);
  EXPECT_TRUE(unchecked().is_null());
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
