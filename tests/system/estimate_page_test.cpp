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
  EXPECT_NE(read_file(dir + "/report.html")
                .find("this estimate were altered or added after it was written: s_graphs_plus.tum"),
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
  EXPECT_NE(read_file(dir + "/report.html").find("this estimate has no plan.json"), std::string::npos);
}

TEST_F(EstimatePages, SayByHowMuchAPlanOfAMapIsMoved) {
  const std::string ifc = at("map.ifc"), local = "#18=IFCLOCALPLACEMENT($,#7);";
  ASSERT_EQ(plumbline({"inspect", project_file("tests/system/short.plan.yaml"), "--ifc", ifc}).code, 0);
  std::string text = read_file(ifc);
  const std::size_t site = text.find(local);
  ASSERT_NE(site, std::string::npos);
  text.replace(site, local.size(),
               "#99001=IFCCARTESIANPOINT((500000.,5000000.,0.));\n#99002=IFCAXIS2PLACEMENT3D(#99001,$,$);\n"
               "#18=IFCLOCALPLACEMENT($,#99002);");
  write_file(ifc, text);
  const Outcome made = estimate("s_graph_localization", {"--plan", ifc}, "map");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string yaml = read_file(at("map") + "/estimate.yaml");
  EXPECT_NE(yaml.find("plan_moved_by_m: [-500005, -5000004, 0]"), std::string::npos) << yaml;
  EXPECT_NE(page("map").find("<dt>plan moved by, m</dt><dd>-500005, -5000004, 0</dd>"), std::string::npos);
}

TEST_F(EstimatePages, ShowNamesThatAreNoUtf8) {
  const std::string recording = at("walk_\xE4"), plan = at("pl\xE4n.plan.yaml");
  fs::copy(walk(), recording, fs::copy_options::recursive);
  write_file(plan, read_file(project_file("tests/system/short.plan.yaml")));
  const Outcome made =
      plumbline({"estimate", recording, "--method", "s_graph_localization", "--plan", plan, "-o", at("latin")});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(page("latin").find("<dt>recording</dt><dd>walk_\u00E4</dd>"), std::string::npos);
  EXPECT_NE(page("latin").find("<dt>plan</dt><dd>pl\u00E4n.plan.yaml</dd>"), std::string::npos);
  EXPECT_EQ(plumbline({"report", at("latin")}).code, 0);
}

TEST_F(EstimatePages, ThatCannotBeMadeCostNoEstimate) {
  const std::string out = at("no_page");
  Setting setting;
  setting.largest_file = 25'000;  // less than a page, more than any other file of so few returns
  const Outcome made = plumbline(
      {"estimate", walk(), "--method", "odometry", "--max-range", "2", "--every", "10", "--one-of", "16", "-o", out},
      setting);
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.err.find("warning: " + out + ": its page cannot be made: "), std::string::npos) << made.err;
  EXPECT_EQ(made.err.find(".partial"), std::string::npos) << made.err;
  EXPECT_EQ(made.out.find("report: "), std::string::npos) << made.out;
  EXPECT_FALSE(fs::exists(out + "/report.html"));
  EXPECT_TRUE(fs::exists(out + "/odometry.tum"));
  EXPECT_EQ(plumbline({"report", out}).code, 0) << "it is made later";
  EXPECT_TRUE(fs::exists(out + "/report.html"));
}

TEST_F(EstimatePages, BelieveNoFileThatWasAdded) {
  const std::string gates =
      R"({"causal": {"poses": 1}, "gates": [{"metric": "a", "method": "m", "op": "<=", "limit": 1, "passed": false,
      "see": "javascript:0"}]
})";
  const std::string truth = read_file(walk() + "/truth.tum");
  const std::vector<std::pair<std::string, std::string>> added = {
      {"score.json", gates}, {"reference.tum", truth}, {"plan.json", read_file(at("plan") + "/plan.json")}};
  for (const auto& [name, text] : added) {
    const std::string dir = copy("slam");
    write_file(dir + "/" + name, text);
    const Outcome refused = plumbline({"report", dir});
    EXPECT_EQ(refused.code, 2) << name;
    EXPECT_NE(refused.err.find("not listed in manifest.csv: " + name + "; move it elsewhere"), std::string::npos)
        << refused.err;
    const Outcome taken = plumbline({"report", dir, "--unchecked"});
    EXPECT_EQ(taken.code, 0) << taken.err;
    const std::string shown = read_file(dir + "/report.html");
    EXPECT_NE(shown.find("altered or added after it was written: " + name), std::string::npos);
    EXPECT_EQ(shown.find("javascript:"), std::string::npos);
    EXPECT_EQ(plumbline({"report", dir}).code, 2) << "what was added stays so";
  }
}

TEST_F(EstimatePages, LeaveTheUsersOwnFilesAlone) {
  const std::string dir = copy("slam");
  fs::copy_file(walk() + "/truth.tum", dir + "/gt.tum");
  write_file(dir + "/cleaned.map.ply", "of another program");
  EXPECT_EQ(plumbline({"report", dir}).code, 0);
  const Outcome scored = plumbline({"score", dir, "--reference", dir + "/gt.tum"});
  EXPECT_EQ(scored.code, 0) << scored.err;
  EXPECT_EQ(read_file(dir + "/score.json").find("unchecked"), std::string::npos);
  EXPECT_TRUE(fs::exists(dir + "/gt.tum"));
}

TEST_F(EstimatePages, OfAScoreStayWhereAFileOfItCannotBeReplaced) {
  const std::string dir = copy("slam");
  const std::string page = read_file(dir + "/report.html");
  fs::create_directory(dir + "/reference.tum");
  const Outcome refused = plumbline({"score", dir});
  EXPECT_EQ(refused.code, 2) << refused.err;
  EXPECT_NE(refused.err.find("reference.tum: is no file that could be replaced"), std::string::npos) << refused.err;
  EXPECT_EQ(read_file(dir + "/report.html"), page);
  EXPECT_FALSE(fs::exists(dir + "/score.json"));
}

TEST_F(EstimatePages, OfAScoreThatIsDamagedAreRefused) {
  const std::string dir = copy("plan");
  for (const char* text : {R"({"gates":[1]})", R"({"gates":[{"metric":"a"}]})",
                           R"({"causal":{"ate_aligned_rmse_m":1e300}})", R"({"causal":[]})", R"({"verdict":[]})"}) {
    write_file(dir + "/score.json", text);
    const Outcome refused = plumbline({"report", dir, "--unchecked"});
    EXPECT_EQ(refused.code, 2) << text << refused.err;
    EXPECT_NE(refused.err.find("score.json"), std::string::npos) << refused.err;
  }
  fs::remove(dir + "/score.json");
  const std::string ticks = "tick_ns,stage,digest\n9223372036854775807,a,0000000000000000\n";
  write_file(dir + "/digests.csv", ticks);
  const Outcome late = plumbline({"report", dir, "--unchecked"});
  EXPECT_EQ(late.code, 2) << late.err;
  EXPECT_NE(late.err.find("digests.csv"), std::string::npos) << late.err;
}

TEST_F(EstimatePages, ThatCannotBeMadeCostNoScore) {
  const std::string dir = copy("slam");
  fs::remove(dir + "/digests.csv");
  EXPECT_EQ(plumbline({"score", dir}).code, 2);
  const Outcome scored = plumbline({"score", dir, "--unchecked"});
  EXPECT_EQ(scored.code, 0) << scored.err;
  EXPECT_NE(scored.out.find("causal"), std::string::npos) << scored.out;
  EXPECT_NE(scored.out.find("scores: " + dir + "/score.json"), std::string::npos) << scored.out;
  EXPECT_EQ(scored.out.find("report: "), std::string::npos) << scored.out;
  EXPECT_NE(scored.err.find("its page cannot be made: digests.csv: "), std::string::npos) << scored.err;
  EXPECT_FALSE(fs::exists(dir + "/report.html")) << "an old page shows no new score";
}

TEST_F(EstimatePages, AreWrittenWithAllOfAScoreOrWithNothing) {
  const std::string dir = copy("slam"), manifest = read_file(dir + "/manifest.csv");
  Setting setting;
  setting.largest_file = 60'000;  // the score and the reference, not the page
  const Outcome full = plumbline({"score", dir, "--reference", at("slam") + "/s_graphs_plus.tum"}, setting);
  EXPECT_EQ(full.code, 3) << full.err;
  EXPECT_NE(full.err.find("report.html"), std::string::npos) << full.err;
  EXPECT_FALSE(fs::exists(dir + "/score.json"));
  EXPECT_FALSE(fs::exists(dir + "/reference.tum"));
  EXPECT_TRUE(read_file(dir + "/report.html") == page("slam"));
  EXPECT_EQ(read_file(dir + "/manifest.csv"), manifest);
}

TEST_F(EstimatePages, ThatAreGoneAreNoDifference) {
  const std::string dir = copy("slam");
  fs::remove(dir + "/report.html");
  const Outcome equal = plumbline({"diff", at("slam"), dir});
  EXPECT_EQ(equal.out, "equal\n");
  EXPECT_EQ(equal.err, "");
}

}  // namespace
}  // namespace plumbline::system_tests
