// SPDX-License-Identifier: Apache-2.0
// The replay page of a run whose gate fails and whose names are hostile: what the run says, that the page comes out the
// same again, and the page itself in a browser where there is one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/system/program.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

const std::string hostile = "a </script><b>x & \"c\"";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

class ReplayPage : public RunOnce<ReplayPage, 1> {
 public:
  static Outcome begin() {
    const std::string plan = read_file(project_file("tests/system/short.plan.yaml"));
    write_file(*folder_ / "short.plan.yaml", replaced(plan, "id: hall,", "id: 'h<img src=x onerror=y>',"));
    std::string scenario = read_file(project_file("tests/system/short.yaml"));
    scenario =
        replaced(replaced(scenario, "name: short", "name: '" + hostile + "'"), "[hall,", "['h<img src=x onerror=y>',");
    write_file(*folder_ / "hostile.yaml", replaced(scenario, "max: 0.25", "max: 0.0001"));
    return plumbline({"run", *folder_ / "hostile.yaml", "--out", dir(), "--threads", "2", "--record"});
  }

 protected:
  static std::string dir() { return *folder_ / "run it"; }
  static std::string page() { return read_file(dir() + "/replay.html"); }
};

TEST_F(ReplayPage, AFailedRunSaysWhereToLook) {
  EXPECT_NE(outcome_->out.find("look:  " + dir() + "/replay.html#t="), std::string::npos) << outcome_->out;
  EXPECT_NE(outcome_->out.find("&m=vgicp\n"), std::string::npos) << outcome_->out;
  EXPECT_NE(outcome_->out.find("again: plumbline replay '" + dir() + "' --until "), std::string::npos) << outcome_->out;
  EXPECT_NE(read_file(dir() + "/junit.xml").find("replay.html#t="), std::string::npos);
  EXPECT_NE(read_file(dir() + "/results.json").find("\"see\": \"replay.html#t="), std::string::npos);
}

TEST_F(ReplayPage, IsOneFileUnderAPolicy) {
  const std::string text = page();
  EXPECT_GT(text.size(), 500'000U);
  EXPECT_LT(text.size(), 3'000'000U);
  EXPECT_EQ(text.find("src="), std::string::npos);
  EXPECT_EQ(text.find("<link"), std::string::npos);
  EXPECT_NE(text.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(text.find("unsafe-inline"), std::string::npos);
  EXPECT_EQ(text.find(hostile), std::string::npos);
  EXPECT_EQ(text.find("<img"), std::string::npos);
  EXPECT_EQ(text.find(dir()), std::string::npos);
}

TEST_F(ReplayPage, ComesOutTheSameAgain) {
  const std::string before = page();
  std::filesystem::remove(dir() + "/replay.html");
  const Outcome again = plumbline({"report", "--3d", dir()});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(page() == before);
}

/// What keeps a script for a browser from running here; empty where nothing does.
std::string no_browser() {
  for (const std::string program : {"node", "chromium"})
    if (std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) != 0)
      return "no " + program + "; ci/setup full installs it";
  return "";
}

TEST_F(ReplayPage, WorksInABrowser) {
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string log = *folder_ / "browser.log";
  const std::string name = replaced(hostile, "\"", "\\\"");
  const std::string command = "node '" + project_file("tests/browser/replay_test.mjs") + "' '" + dir() + "' \"" + name +
                              "\" >'" + log + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_file(log);
}

TEST_F(ReplayPage, TheReportIsLegibleAndWorksByKeyboardAndOnAPhone) {
  if (const std::string missing = no_browser(); !missing.empty()) GTEST_SKIP() << missing;
  const std::string log = *folder_ / "pages.log";
  const std::string command =
      "node '" + project_file("tests/browser/pages_test.mjs") + "' '" + dir() + "/report.html' >'" + log + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << read_file(log);
}

}  // namespace
}  // namespace plumbline::system_tests
