// SPDX-License-Identifier: Apache-2.0
// Files out of `inspect`: IFC that reads back, meshes, and what is refused.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

class Exchange : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    plan_ = project_file("scenarios/library/construction_site.plan.yaml");
  }

  /// The value of "hash" in what inspect prints.
  static std::string hash_of(const std::string& building, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"inspect", building, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t at = outcome.out.find("\"hash\": \"");
    EXPECT_NE(at, std::string::npos);
    return at == std::string::npos ? std::string() : outcome.out.substr(at + 9, 16);
  }

  void refuse(const std::vector<std::string>& arguments, int code, const std::string& word) const {
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }

  Folder folder_;
  std::string plan_;
};

TEST_F(Exchange, WrittenIfcHasTheHashOfThePlan) {
  const std::string hash = hash_of(plan_, {"--ifc", folder_ / "planned.ifc"});
  EXPECT_EQ(hash_of(folder_ / "planned.ifc", {"--ifc", folder_ / "again.ifc"}), hash);
  EXPECT_EQ(read_file(folder_ / "again.ifc"), read_file(folder_ / "planned.ifc"));
}

TEST_F(Exchange, AsBuiltIsAnotherBuilding) {
  const std::string built = hash_of(plan_, {"--as-built", "--ifc", folder_ / "built.ifc"});
  EXPECT_NE(built, hash_of(plan_));
  EXPECT_EQ(hash_of(folder_ / "built.ifc"), built);
}

/// The strongest sense of being the same building: no stage of a run sees a difference.
TEST_F(Exchange, ARunInWrittenIfcIsTheRunInThePlan) {
  const std::string scenario = read_file(project_file("tests/system/short.yaml"));
  const std::size_t at = scenario.find("short.plan.yaml");
  ASSERT_NE(at, std::string::npos);
  write_file(folder_ / "plan.yaml", scenario);
  write_file(folder_ / "ifc.yaml", std::string(scenario).replace(at, 15, "short.ifc"));
  write_file(folder_ / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  (void)hash_of(folder_ / "short.plan.yaml", {"--ifc", folder_ / "short.ifc"});
  for (const char* name : {"plan", "ifc"}) {
    const Outcome outcome = plumbline({"run", (folder_ / name) + ".yaml", "--out", folder_ / name});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  for (const char* name : {"digests.csv", "results.json", "truth.tum"})
    EXPECT_EQ(read_file((folder_ / "ifc/") + name), read_file((folder_ / "plan/") + name)) << name;
}

TEST_F(Exchange, MeshesAreTheSameBytesInEachProcess) {
  for (const char* name : {"a.glb", "a.obj", "a.ply"}) {
    (void)hash_of(plan_, {"--mesh", folder_ / name});
    const std::string first = read_file(folder_ / name);
    EXPECT_GT(first.size(), 1000u) << name;
    std::filesystem::remove(folder_ / name);
    (void)hash_of(plan_, {"--mesh", folder_ / name});
    EXPECT_EQ(read_file(folder_ / name), first) << name;
  }
}

TEST_F(Exchange, WhatCannotBeWrittenIsRefused) {
  refuse({"inspect", plan_, "--mesh", folder_ / "out.stl"}, 2, ".glb, .obj or .ply");
  refuse({"inspect", plan_, "--mesh", folder_ / "none/out.glb"}, 3, "cannot be written");
  refuse({"inspect", plan_, "--ifc", folder_ / "none/out.ifc"}, 3, "cannot be written");
  refuse({"inspect", plan_, "--ifc", folder_.path()}, 2, "exists already; --force replaces it");
  refuse({"inspect", plan_, "--ifc", folder_.path(), "--force"}, 2, "is no file that could be replaced");
  const std::string fifo = folder_ / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  refuse({"inspect", plan_, "--ifc", fifo, "--force"}, 2, "is no file that could be replaced");
  EXPECT_TRUE(std::filesystem::is_fifo(fifo));
  const std::string text = read_file(plan_);
  write_file(folder_ / "own.plan.yaml", text);
  refuse({"inspect", folder_ / "own.plan.yaml", "--ifc", folder_ / "own.plan.yaml"}, 2, "overwrite");
  EXPECT_EQ(read_file(folder_ / "own.plan.yaml"), text);
  write_file(folder_ / "kept.glb", "kept");
  refuse({"inspect", plan_, "--mesh", folder_ / "kept.glb"}, 2, "exists already; --force replaces it");
  EXPECT_EQ(read_file(folder_ / "kept.glb"), "kept");
  refuse({"inspect", plan_, "--mesh", folder_ / "one.glb", "--ifc", folder_ / "one.glb"}, 2, "names the file");
  EXPECT_EQ(plumbline({"inspect", plan_, "--mesh", folder_ / "kept.glb", "--force"}).code, 0);
  EXPECT_EQ(read_file(folder_ / "kept.glb").substr(0, 4), "glTF");
}

}  // namespace
}  // namespace plumbline::system_tests
