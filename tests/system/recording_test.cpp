// SPDX-License-Identifier: Apache-2.0
// Recordings: what estimate says of one is what run said in process; what is no recording is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

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
    const Outcome outcome = plumbline({"estimate", recording, "--method", method, "--plan", plan(), "-o", out});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    int compared = 0;
    for (const char* end : {".tum", ".final.tum", ".estimate.json", ".map.ply", ".hypotheses.jsonl"}) {
      ASSERT_EQ(fs::exists(out + "/" + method + end), fs::exists(run + "/" + method + end)) << method << end;
      if (!fs::exists(out + "/" + method + end)) continue;
      EXPECT_TRUE(read_file(out + "/" + method + end) == read_file(run + "/" + method + end)) << method << end;
      ++compared;
    }
    EXPECT_GE(compared, 4);
  }

  Folder folder_;
};

TEST_F(Recordings, EstimateSaysWhatRunSaid) {
  const std::string run = folder_ / "run";
  const std::string methods = "odometry,vgicp,s_graphs_plus,s_graph_localization";
  ASSERT_EQ(plumbline({"run", input(), "--out", run, "--record", "--method", methods}).code, 0);
  const std::string walk = folder_ / "walk";
  ASSERT_EQ(plumbline({"simulate", input(), "-o", walk}).code, 0);
  for (const char* name : {"lidar.pcap", "odometry.tum", "imu.csv", "recording.yaml"})
    EXPECT_TRUE(read_file(walk + "/" + name) == read_file(run + "/recording/" + name)) << name;
  EXPECT_TRUE(read_file(walk + "/truth.tum") == read_file(run + "/truth.tum"));

  for (const char* name : {"truth.tum", "scenario.yaml", "building.plan.yaml"}) fs::remove(walk + "/" + name);
  for (const char* method : {"odometry", "vgicp", "s_graphs_plus", "s_graph_localization"})
    expect_same(walk, run, method);
}

}  // namespace
}  // namespace plumbline::system_tests
