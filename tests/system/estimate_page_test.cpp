// SPDX-License-Identifier: Apache-2.0
// The real program writes a page of an estimate, and writes it again.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "bim/config/tree.h"
#include "tests/occurrences.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class EstimatePages : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!available()) return;
    folder_ = std::make_unique<Folder>();
    ASSERT_EQ(plumbline({"simulate", project_file("tests/system/short.yaml"), "-o", walk()}).code, 0);
    ASSERT_EQ(estimate("s_graphs_plus", {}, "slam").code, 0);
    ASSERT_EQ(estimate("s_graph_localization", {"--plan", project_file("tests/system/short.plan.yaml")}, "plan").code,
              0);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  /// A folder whose name a page must not take for its own.
  static std::string walk() { return *folder_ / "walk <b>&"; }
  static std::string at(const std::string& name) { return *folder_ / name; }
  static Outcome estimate(const std::string& method, const std::vector<std::string>& more, const std::string& out) {
    std::vector<std::string> all{"estimate", walk(), "--method", method, "-o", at(out)};
    all.insert(all.end(), more.begin(), more.end());
    return plumbline(all);
  }
  static std::string page(const std::string& out) { return read_file(at(out) + "/report.html"); }
  /// A copy to change.
  static std::string copy(const std::string& out) {
    fs::remove_all(at("copy"));
    fs::copy(at(out), at("copy"), fs::copy_options::recursive);
    return at("copy");
  }
  static std::unique_ptr<Folder> folder_;
};
std::unique_ptr<Folder> EstimatePages::folder_;

TEST_F(EstimatePages, AreWrittenAgainWithTheSameBytes) {
  for (const char* name : {"slam", "plan"}) {
    const std::string first = page(name), dir = copy(name);
    const std::string manifest = read_file(dir + "/manifest.csv");
    EXPECT_NE(manifest.find("\nreport.html,"), std::string::npos) << manifest;
    fs::remove(dir + "/report.html");  // it is made of the others
    for (int i = 0; i < 2; ++i) {
      const Outcome again = plumbline({"report", dir});
      ASSERT_EQ(again.code, 0) << again.err;
      EXPECT_EQ(again.out, "report: " + dir + "/report.html\n");
      EXPECT_TRUE(read_file(dir + "/report.html") == first) << name;
      EXPECT_EQ(read_file(dir + "/manifest.csv"), manifest);
    }
    EXPECT_EQ(plumbline({"score", dir}).code, 0) << "the manifest has the page";
  }
}

TEST_F(EstimatePages, RepeatWithTheEstimate) {
  ASSERT_EQ(estimate("s_graphs_plus", {}, "slam_again").code, 0);
  EXPECT_TRUE(page("slam_again") == page("slam"));
  EXPECT_EQ(read_file(at("slam_again") + "/manifest.csv"), read_file(at("slam") + "/manifest.csv"));
}

TEST_F(EstimatePages, NameTheCommandThatMakesThemAgain) {
  write_file(at("short.plan.yaml"), read_file(project_file("tests/system/short.plan.yaml")));
  write_file(at("other values.yaml"), "max_range_m: 20\n");
  const std::vector<std::string> localized = {
      "--plan", at("short.plan.yaml"), "--yaw-deg", "58.5", "--storey", "ground", "--seed", "4", "--every",
      "2",      "--plan-furniture",    "none"};
  ASSERT_EQ(estimate("s_graph_localization", localized, "first_plan").code, 0);
  const std::vector<std::string> plain = {"--config", at("other values.yaml"), "--without", "rings,times", "--sensors",
                                          "lidar"};
  ASSERT_EQ(estimate("kiss_icp", plain, "first_kiss").code, 0);
  for (const char* name : {"first_plan", "first_kiss"}) {
    const std::string yaml = read_file(at(name) + "/estimate.yaml");
    std::string command = read_yaml(yaml, "estimate.yaml").find("given")->find("command")->as_string();
    ASSERT_EQ(command.rfind("plumbline ", 0), 0U) << command;
    command.replace(0, 9, std::getenv("PLUMBLINE_BINARY"));
    fs::remove_all(at("again"));
    ASSERT_EQ(std::system(("cd '" + folder_->path() + "' && " + command + " >again.log 2>&1").c_str()), 0)
        << command << read_file(at("again.log"));
    EXPECT_TRUE(page("again") == page(name)) << command;
    EXPECT_EQ(read_file(at("again") + "/estimate.yaml"), yaml);
  }
}

TEST_F(EstimatePages, SayWhatCameOut) {
  const std::string slam = page("slam"), plan = page("plan");
  EXPECT_NE(slam.find("118 of 118 scans have a pose, never LOST"), std::string::npos);
  EXPECT_NE(slam.find("upright surface in the method's map"), std::string::npos);
  EXPECT_NE(plan.find("CONVERGED at the end"), std::string::npos);
  EXPECT_NE(plan.find("Ended CONVERGED in "), std::string::npos);
  EXPECT_NE(plan.find("id=\"belief-s_graph_localization\""), std::string::npos);
  EXPECT_NE(plan.find("<dt>plan</dt><dd>short.plan.yaml</dd>"), std::string::npos);
  EXPECT_GT(occurrences(plan, "class=\"wall\""), 10U);
  for (const std::string& each : {slam, plan}) {
    EXPECT_EQ(occurrences(each, "walk <b>"), 0U);
    EXPECT_NE(each.find("<dt>recording</dt><dd>walk &lt;b&gt;&amp;</dd>"), std::string::npos);
    EXPECT_EQ(occurrences(each, folder_->path()), 0U) << "no path of this machine";
    EXPECT_EQ(occurrences(each, "ground truth"), 0U);
    EXPECT_NE(each.find("plumbline estimate 'walk &lt;b&gt;&amp;' --method s_graph"), std::string::npos);
  }
}

TEST_F(EstimatePages, OfAlteredFilesAreRefusedOrNameThem) {
  const std::string dir = copy("slam");
  write_file(dir + "/s_graphs_plus.tum", read_file(dir + "/s_graphs_plus.tum") + "# more\n");
  const std::string before = read_file(dir + "/report.html");
  const Outcome refused = plumbline({"report", dir});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("s_graphs_plus.tum"), std::string::npos) << refused.err;
  EXPECT_TRUE(read_file(dir + "/report.html") == before);
  const Outcome taken = plumbline({"report", dir, "--unchecked"});
  EXPECT_EQ(taken.code, 0) << taken.err;
  EXPECT_NE(
      read_file(dir + "/report.html").find("this estimate were altered after they were written: s_graphs_plus.tum"),
      std::string::npos);
  EXPECT_EQ(plumbline({"report", dir}).code, 2) << "what was altered stays so";
}

TEST_F(EstimatePages, ShowAReferenceThatScoreWasGiven) {
  const std::string dir = copy("slam"), truth = walk() + "/truth.tum";
  ASSERT_EQ(plumbline({"score", dir, "--reference", truth, "--gate", "ate_aligned_rmse_m<=1e-9"}).code, 1);
  const std::string scored = read_file(dir + "/report.html");
  EXPECT_NE(scored.find("By the reference, aligned: position error"), std::string::npos);
  EXPECT_NE(scored.find("id=\"errors\""), std::string::npos);
  EXPECT_NE(scored.find("gates that failed"), std::string::npos);
  ASSERT_EQ(plumbline({"report", dir}).code, 0);
  EXPECT_TRUE(read_file(dir + "/report.html") == scored);
  write_file(dir + "/reference.tum", "");
  EXPECT_EQ(plumbline({"report", dir}).code, 2) << "the reference is compared with the manifest";
  ASSERT_EQ(plumbline({"score", dir}).code, 0);
  EXPECT_FALSE(fs::exists(dir + "/reference.tum"));
  EXPECT_EQ(read_file(dir + "/report.html").find("id=\"errors\""), std::string::npos);
  EXPECT_EQ(plumbline({"report", dir}).code, 0);

  const std::string plan = copy("plan");
  ASSERT_EQ(plumbline({"score", plan, "--reference", truth + ",frame=W"}).code, 0);
  EXPECT_NE(read_file(plan + "/report.html").find("By the reference in the plan's frame: success"), std::string::npos);
}

TEST_F(EstimatePages, OfDamagedOrOtherDirectoriesAreRefused) {
  const Outcome replay = plumbline({"report", "--3d", at("slam")});
  EXPECT_EQ(replay.code, 2);
  EXPECT_NE(replay.err.find("--3d"), std::string::npos) << replay.err;
  const std::string dir = copy("plan");
  write_file(dir + "/plan.json", "{\"storeys\": [");
  const Outcome damaged = plumbline({"report", dir, "--unchecked"});
  EXPECT_EQ(damaged.code, 2);
  EXPECT_NE(damaged.err.find("plan.json"), std::string::npos) << damaged.err;
  fs::remove(dir + "/plan.json");
  EXPECT_EQ(plumbline({"report", dir, "--unchecked"}).code, 0) << "an estimate of an earlier version has none";
}

}  // namespace
}  // namespace plumbline::system_tests
