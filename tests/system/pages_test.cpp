// SPDX-License-Identifier: Apache-2.0
// Pages of a sweep and of identify: what they say, and that they keep to what every page keeps to, in a browser where
// there is one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "bim/config/tree.h"
#include "tests/system/program.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class Pages : public RunOnce<Pages> {
 public:
  static Outcome begin() {
    for (const char* name : {"short.yaml", "short.plan.yaml"})
      write_file(*folder_ / name, read_file(project_file(std::string("tests/system/") + name)));
    write_file(*folder_ / "sweep.yaml",
               "sweep: 1\nscenarios: [short.yaml]\nseeds: 2\nmethods: [odometry]\n"
               "variants: [{name: two, set: [duration_s=2]}]\n");
    return plumbline({"sweep", *folder_ / "sweep.yaml", "-o", out(), "--jobs", "2", "--page", "worst"});
  }

 protected:
  static std::string out() { return *folder_ / "out"; }
};

TEST_F(Pages, ASweepLinksThePageOfItsWorstRunAndItIsThatRun) {
  const std::string page = read_file(out() + "/table.html");
  const std::size_t at = page.find("href=\"pages/");
  ASSERT_NE(at, std::string::npos);
  const std::string key = page.substr(at + 12, page.find('/', at + 12) - at - 12);
  for (const char* file : {"report.html", "replay.html"}) EXPECT_TRUE(fs::exists(out() + "/pages/" + key + "/" + file));
  const auto digest = [](const std::string& file) {
    return read_json(read_file(file), file).find("digest")->as_string();
  };
  EXPECT_EQ(digest(out() + "/pages/" + key + "/results.json"), digest(out() + "/results/" + key + ".json"));
  EXPECT_NE(page.find("--page short-two-"), std::string::npos);  // of the other run, the command
}

TEST_F(Pages, AnUnknownRunIsRefused) {
  const Outcome refused = plumbline({"sweep", *folder_ / "sweep.yaml", "-o", out(), "--page", "short-9"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--page: the sweep has no run 'short-9'"), std::string::npos) << refused.err;
}

/// What keeps a script for a browser from running here; empty where nothing does.
std::string no_browser() {
  for (const std::string program : {"node", "chromium"})
    if (std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) != 0)
      return "no " + program + "; ci/setup full installs it";
  return "";
}

/// What the script says of pages; empty where all keep to it.
std::string faults_of(const std::vector<std::string>& pages, const std::string& log) {
  std::string command = "node '" + project_file("tests/browser/pages_test.mjs") + "'";
  for (const std::string& page : pages) command += " '" + page + "'";
  return std::system((command + " >'" + log + "' 2>&1").c_str()) == 0 ? "" : read_file(log);
}

TEST_F(Pages, KeepToContrastPhonesAndKeys) {
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  const Outcome identified =
      plumbline({"identify", *folder_ / "short.plan.yaml", "--step", "1", "-o", *folder_ / "i.html"});
  ASSERT_EQ(identified.code, 0) << identified.err;
  const Outcome walked = plumbline({"inspect", *folder_ / "short.plan.yaml", "--walk", *folder_ / "w.html"});
  ASSERT_EQ(walked.code, 0) << walked.err;
  EXPECT_EQ(faults_of({out() + "/table.html", *folder_ / "i.html", *folder_ / "w.html"}, *folder_ / "pages.log"), "");
}

// Of 22 rooms on two storeys.
TEST_F(Pages, OfALargerBuildingFitAPhone) {
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string page = *folder_ / "house.html";
  const Outcome identified =
      plumbline({"identify", project_file("scenarios/library/house.plan.yaml"), "--step", "1", "-o", page});
  ASSERT_EQ(identified.code, 0) << identified.err;
  EXPECT_EQ(faults_of({page}, *folder_ / "house.log"), "");
}

TEST_F(Pages, OfEstimatesKeepToItToo) {
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string walk = *folder_ / "walk", plan = *folder_ / "short.plan.yaml";
  ASSERT_EQ(plumbline({"simulate", *folder_ / "short.yaml", "-o", walk}).code, 0);
  std::vector<std::string> pages;
  const auto estimate = [&](const std::string& method, std::vector<std::string> more, const std::string& reference) {
    const std::string out = *folder_ / ("estimate_" + method);
    more.insert(more.begin(), {"estimate", walk, "--method", method, "-o", out});
    ASSERT_EQ(plumbline(more).code, 0);
    ASSERT_EQ(plumbline({"score", out, "--reference", reference}).code, 0);
    pages.push_back(*folder_ / (method + ".html"));  // by its name report.html is taken for a run's
    fs::copy(out + "/report.html", pages.back());
  };
  estimate("s_graphs_plus", {}, walk + "/truth.tum");
  estimate("s_graph_localization", {"--plan", plan}, walk + "/truth.tum,frame=W");
  EXPECT_EQ(faults_of(pages, *folder_ / "estimates.log"), "");
}

TEST_F(Pages, OfSlamThatIsFarOffSaySo) {
  const std::string stuck = fs::path(std::getenv("PLUMBLINE_BINARY")).parent_path() / "tests/hostile_process";
  const std::string run = *folder_ / "far";
  const Outcome far = plumbline(
      {"run", *folder_ / "short.yaml", "--method", "odometry,stuck=" + stuck + " good", "--replay", "-o", run});
  ASSERT_EQ(far.code, 0) << far.err;
  EXPECT_NE(far.out.find("\nnot judged: stuck: off by "), std::string::npos) << far.out;
  EXPECT_NE(far.out.find("look:  " + run + "/replay.html#m=stuck\n"), std::string::npos) << far.out;
  EXPECT_NE(read_file(run + "/report.html").find("rms, not judged</a>"), std::string::npos);
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  EXPECT_EQ(faults_of({run + "/report.html", run + "/replay.html"}, *folder_ / "far.log"), "");
}

// Two flats that are alike, and a method that settles on one.
TEST_F(Pages, OfALocalizationThatFailsKeepToThat) {
  ASSERT_EQ(plumbline({"generate", "rot180", "-o", *folder_ / "alike.plan.yaml"}).code, 0);
  write_file(*folder_ / "alike.yaml",
             "scenario: 1\nname: alike\nbuilding: alike.plan.yaml\nstart: {room: living_a}\n"
             "route: {rooms: [hall_a]}\nduration_s: 12\nprior: {yaw: unknown}\n"
             "methods: [s_graph_localization, s_graph_localization_paper]\ngates:\n"
             "  - {metric: localization.sure_and_wrong, method: s_graph_localization_paper, max: 0}\n");
  const std::string run = *folder_ / "alike";
  const Outcome failed = plumbline({"run", *folder_ / "alike.yaml", "-o", run});
  ASSERT_EQ(failed.code, 1) << failed.out << failed.err;
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  EXPECT_EQ(faults_of({run + "/report.html", run + "/replay.html"}, *folder_ / "alike.log"), "");
}

}  // namespace
}  // namespace plumbline::system_tests
