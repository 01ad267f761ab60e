// SPDX-License-Identifier: Apache-2.0
// A plain mesh as a world: what inspect writes is walked in, and nothing is localized.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

class MeshWorldRun : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    const Outcome outcome =
        plumbline({"inspect", project_file("scenarios/library/quickstart.plan.yaml"), "--mesh", folder_ / "q.glb"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  Folder folder_;
};

TEST_F(MeshWorldRun, ListsItsElements) {
  const Outcome outcome = plumbline({"inspect", folder_ / "q.glb", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "mesh");
  EXPECT_GE(json["obstacles"].size(), 20u);
  for (const auto& element : json["obstacles"]) EXPECT_TRUE(element["closed"].get<bool>()) << element["id"];
}

TEST_F(MeshWorldRun, IsWalkedInBySlamAlone) {
  write_file(folder_ / "walk.yaml", "scenario: 1\nname: walk\nbuilding: q.glb\nduration_s: 25\n");
  const Outcome outcome =
      plumbline({"run", folder_ / "walk.yaml", "--method", "vgicp,s_graphs_plus", "--out", folder_ / "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(read_file(folder_ / "out/results.json"));
  // It walks: 25 s at 0.6 m/s with turns; a box across a doorway would hold it back.
  EXPECT_GT(json["distance_m"].get<double>(), 8.0);
  // Measured 0.01 to 0.06 m over whole rounds.
  EXPECT_LT(json["methods"]["vgicp"]["ate_aligned_rmse_m"].get<double>(), 0.1);

  // Of what is not known nothing is scored, and it is said.
  EXPECT_FALSE(json["methods"]["s_graphs_plus"].contains("walls"));
  EXPECT_FALSE(json["methods"]["s_graphs_plus"].contains("rooms"));
  ASSERT_FALSE(json["walk"]["warnings"].empty());
  EXPECT_EQ(json["walk"]["warnings"][0].get<std::string>().rfind("no rooms are known on ground: ", 0), 0U);

  // Nobody knows what else looks like it in a world without walls.
  ASSERT_EQ(plumbline({"score", folder_ / "out", "--estimate", "given=" + (folder_ / "out/truth.tum,frame=W")}).code,
            0);
  const auto scored = nlohmann::json::parse(read_file(folder_ / "out/results.json"));
  EXPECT_TRUE(scored["methods"]["given"]["localization"].contains("converged_at_s"));
  EXPECT_FALSE(scored["methods"]["given"]["localization"].contains("identifiable"));
  const Outcome refused = plumbline({"identify", folder_ / "walk.yaml"});
  EXPECT_EQ(refused.code, 2) << refused.out;
  EXPECT_NE(refused.err.find("has no walls"), std::string::npos) << refused.err;
}

TEST_F(MeshWorldRun, RefusesPlanLocalization) {
  const Outcome outcome =
      plumbline({"run", folder_ / "q.glb", "--method", "s_graph_localization", "--out", folder_ / "out"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("'s_graph_localization' localizes in a plan"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace plumbline::system_tests
