// SPDX-License-Identifier: Apache-2.0
// Recordings of which a method gets less than usual: wrong sensors, scans alone, few or plain scans, no packets.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/system/recordings.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

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

TEST_F(Recordings, ScansWithoutReturnsAreNamed) {
  const std::string clouds = folder_ / "clouds";
  fs::create_directory(clouds);
  for (int i = 0; i < 5; ++i) write_file(clouds + "/" + std::to_string(i) + ".bin", std::string(1600, '\0'));
  const Outcome outcome = plumbline({"estimate", clouds, "--method", "vgicp", "-o", folder_ / "nothing"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("5 of 5 scans hold no return"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("5 scans, no rings"), std::string::npos) << outcome.out;
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
  const std::string walk = this->walk("walk"), whole = folder_ / "whole", degraded = folder_ / "degraded";
  const auto lines = [](const std::string& file) {
    std::istringstream in(read_file(file));
    std::vector<std::string> stamps;
    for (std::string line; std::getline(in, line);) stamps.push_back(line.substr(0, line.find(' ')));
    return stamps;
  };
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "-o", whole}).code, 0);
  EXPECT_EQ(read_file(whole + "/estimate.yaml").find("every"), std::string::npos);
  const Outcome outcome =
      plumbline({"estimate", walk, "--method", "vgicp", "--every", "4", "--without", "rings,times", "-o", degraded});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string said = read_file(degraded + "/estimate.yaml");
  EXPECT_NE(said.find("every: 4"), std::string::npos) << said;
  for (const char* word : {"without:", "rings", "times"}) EXPECT_NE(said.find(word), std::string::npos) << said;
  const auto all = lines(whole + "/vgicp.tum"), some = lines(degraded + "/vgicp.tum");
  ASSERT_EQ(some.size(), (all.size() + 3) / 4);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], all[4 * i]);
  ASSERT_EQ(plumbline({"score", degraded, "--reference", walk + "/truth.tum"}).code, 0);
  EXPECT_EQ(nlohmann::json::parse(read_file(degraded + "/score.json"))["silence"]["silent_s"], 0.0);
  refuse({walk, "--method", "vgicp", "--every", "0"}, "plumbline: --every", "estimate --help");
  refuse({walk, "--method", "vgicp", "--without", "points"}, "plumbline: --without", "estimate --help");
  refuse({walk, "--method", "vgicp", "--max-range", "0"}, "plumbline: --max-range", "estimate --help");
  const std::string thin = folder_ / "thin";
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp", "--max-range", "6", "--one-of", "2", "--beams", "8", "-o",
                       thin})
                .code,
            0);
  const std::string thinned = read_file(thin + "/estimate.yaml");
  for (const char* word : {"max_range_m: 6", "one_of: 2", "beams: 8"})
    EXPECT_NE(thinned.find(word), std::string::npos) << thinned;
  EXPECT_NE(read_file(thin + "/vgicp.tum"), read_file(whole + "/vgicp.tum"));
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

// The floor's rings are bent where they go up a wall. Their planes held the robot where it was: 22 m off without times,
// 6 m with them. Here it is 5 to 6 cm.
TEST_F(Recordings, AlongACorridorScansWithoutRingsAreTracked) {
  write_file(folder_ / "lc1.yaml",
             "scenario: 1\nbuilding: " + project_file("scenarios/library/s_graphs/lc1.plan.yaml") +
                 "\nstart: {storey: ground, at: [1.2, 1.2]}\nroute: {shuttle: corridor}\n"
                 "speed_mps: 0.9\nduration_s: 15\n");
  const std::string walk = folder_ / "walk";
  ASSERT_EQ(plumbline({"simulate", folder_ / "lc1.yaml", "-o", walk}).code, 0);
  for (const char* order : {"rings", "rings,times"}) {
    const std::string out = folder_ / order;
    ASSERT_EQ(plumbline({"estimate", walk, "--method", "vgicp.lidar", "--without", order, "-o", out}).code, 0);
    ASSERT_EQ(plumbline({"score", out, "--reference", walk + "/truth.tum"}).code, 0);
    EXPECT_LT(nlohmann::json::parse(read_file(out + "/score.json"))["causal"]["ate_aligned_rmse_m"], 0.2) << order;
  }
}

// As by odometry of base_footprint. A slab has an underside, too, onto which a pose must not sink.
TEST_F(Recordings, ARobotWhoseFrameLiesOnTheFloorStaysOnIt) {
  std::string scenario = read_file(input());
  scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 14");
  write_file(folder_ / "walk.yaml", scenario);
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string good = folder_ / "good";
  ASSERT_EQ(plumbline({"simulate", folder_ / "walk.yaml", "-o", good}).code, 0);
  std::string text = read_file(good + "/recording.yaml");
  const std::size_t at = text.find("position_m: [0, 0, 0.16]");
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at, 24, "position_m: [0, 0, 0.66]");
  write_file(folder_ / "footprint.yaml", text);
  const Outcome outcome = plumbline({"estimate", good + "/lidar.pcap", "--description", folder_ / "footprint.yaml",
                                     "--method", "s_graph_localization", "--plan", plan(), "-o", folder_ / "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream poses(read_file(folder_ / "out/s_graph_localization.tum"));
  int count = 0;
  for (std::string line; std::getline(poses, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream numbers(line);
    double t = 0.0, x = 0.0, y = 0.0, z = 0.0;
    numbers >> t >> x >> y >> z;
    EXPECT_NEAR(z, 0.0, 0.06) << line;
    ++count;
  }
  EXPECT_GT(count, 10);
}

// With a height that is off, no pose fits the plan. A walk that is too short shows the same.
TEST_F(Recordings, AHeightThatIsNotGivenIsDoubtedWhereNoPoseFits) {
  std::string scenario = read_file(input());
  scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 1");
  write_file(folder_ / "walk.yaml", scenario);
  write_file(folder_ / "short.plan.yaml", read_file(plan()));
  const std::string good = folder_ / "good";
  ASSERT_EQ(plumbline({"simulate", folder_ / "walk.yaml", "-o", good}).code, 0);
  std::vector<std::string> all{"estimate", good + "/lidar.pcap", "--method", "s_graph_localization", "--plan", plan(),
                               "-o",       folder_ / "unknown"};
  const Outcome unknown = plumbline(all);
  ASSERT_EQ(unknown.code, 0) << unknown.err;
  EXPECT_NE(unknown.err.find("above the floor, which is not given"), std::string::npos) << unknown.err;
  EXPECT_NE(read_file(folder_ / "unknown/estimate.yaml").find("which is not given"), std::string::npos);
  all.back() = folder_ / "known";
  all.insert(all.end(), {"--description", good + "/recording.yaml"});
  const Outcome known = plumbline(all);
  ASSERT_EQ(known.code, 0) << known.err;
  EXPECT_EQ(known.err.find("which is not given"), std::string::npos) << known.err;
}

}  // namespace
}  // namespace plumbline::system_tests
