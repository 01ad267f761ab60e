// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace plumbline::system_tests {

/// Recordings of a short walk, made by the program, and what estimate must say of them.
class Recordings : public ::testing::Test {
 protected:
  static std::string input() { return project_file("tests/system/emulated.yaml"); }
  static std::string plan() { return project_file("tests/system/short.plan.yaml"); }

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
      ASSERT_EQ(std::filesystem::exists(out + "/" + method + end), std::filesystem::exists(run + "/" + method + end))
          << method << end;
      if (!std::filesystem::exists(out + "/" + method + end)) continue;
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
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused"));
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
    if (!std::filesystem::exists(made)) {
      std::string scenario = read_file(input());
      scenario.replace(scenario.find("duration_s: 5"), 13, "duration_s: 1");
      write_file(folder_ / "second.yaml", scenario);
      write_file(folder_ / "short.plan.yaml", read_file(plan()));
      EXPECT_EQ(plumbline({"simulate", folder_ / "second.yaml", "-o", made, "--bag"}).code, 0);
    }
    std::filesystem::copy(made, folder_ / name, std::filesystem::copy_options::recursive);
    std::filesystem::remove(folder_ / (name + "/manifest.csv"));  // it would refuse what tests make of the copy
    return folder_ / name;
  }

  static void cut(const std::string& file, double share) {
    std::filesystem::resize_file(
        file, static_cast<std::uintmax_t>(share * static_cast<double>(std::filesystem::file_size(file))));
  }

  Folder folder_;
};

}  // namespace plumbline::system_tests
