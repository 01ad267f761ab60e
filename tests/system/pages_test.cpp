// SPDX-License-Identifier: Apache-2.0
// Pages of a sweep and of identify: what they say, and that they keep to what every page keeps to, in a browser where
// there is one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "bim/config/tree.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class Pages : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!available()) return;
    folder_ = new Folder();
    for (const char* name : {"short.yaml", "short.plan.yaml"})
      write_file(*folder_ / name, read_file(project_file(std::string("tests/system/") + name)));
    write_file(*folder_ / "sweep.yaml",
               "sweep: 1\nscenarios: [short.yaml]\nseeds: 2\nmethods: [odometry]\n"
               "variants: [{name: two, set: [duration_s=2]}]\n");
    outcome_ =
        new Outcome(plumbline({"sweep", *folder_ / "sweep.yaml", "-o", out(), "--jobs", "2", "--page", "worst"}));
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete outcome_;
    folder_ = nullptr;
    outcome_ = nullptr;
  }
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    ASSERT_EQ(outcome_->code, 0) << outcome_->out << outcome_->err;
  }
  static std::string out() { return *folder_ / "out"; }

  static Folder* folder_;
  static Outcome* outcome_;
};
Folder* Pages::folder_ = nullptr;
Outcome* Pages::outcome_ = nullptr;

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

TEST_F(Pages, KeepToContrastPhonesAndKeys) {
  for (const std::string program : {"node", "chromium"})
    if (std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) != 0)
      GTEST_SKIP() << "no " << program << "; ci/setup full installs it";
  const Outcome identified =
      plumbline({"identify", *folder_ / "short.plan.yaml", "--step", "1", "-o", *folder_ / "i.html"});
  ASSERT_EQ(identified.code, 0) << identified.err;
  const Outcome walked = plumbline({"inspect", *folder_ / "short.plan.yaml", "--walk", *folder_ / "w.html"});
  ASSERT_EQ(walked.code, 0) << walked.err;
  const std::string log = *folder_ / "pages.log";
  const std::string command = "node '" + project_file("tests/browser/pages_test.mjs") + "' '" + out() +
                              "/table.html' '" + (*folder_ / "i.html") + "' '" + (*folder_ / "w.html") + "' >'" + log +
                              "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_file(log);
}

}  // namespace
}  // namespace plumbline::system_tests
