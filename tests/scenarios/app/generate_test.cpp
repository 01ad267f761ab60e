// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/load/load.h"
#include "scenarios/spec/scenario.h"
#include "tests/folder.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

class GenerateCommand : public testing::Test {
 protected:
  void SetUp() override {
    const char* binary = std::getenv("PLUMBLINE_BINARY");
    if (binary == nullptr) GTEST_SKIP() << "PLUMBLINE_BINARY is not set; run through ctest";
    binary_ = binary;
  }

  /// Exit code; what the program says stands in `said_`.
  int run(const std::string& arguments) {
    const std::string log = folder_ / "said";
    const int status = std::system(
        ("cd '" + folder_.path() + "' && '" + binary_ + "' generate " + arguments + " > '" + log + "' 2>&1").c_str());
    said_ = fs::file_size(log) > 0 ? read_text_file(log) : "";
    return status / 256;
  }

  std::string binary_, said_;
  Folder folder_;
};

TEST_F(GenerateCommand, WritesAPlanAndAScenarioAndReplacesNothing) {
  ASSERT_EQ(run("corridor --rooms 3 -o c.plan.yaml --scenario c.yaml"), 0) << said_;
  const std::string plan = read_text_file(folder_ / "c.plan.yaml");
  EXPECT_EQ(plan.rfind("# Made by: plumbline generate corridor --rooms 3\nplan: 1\n", 0), 0U);
  EXPECT_EQ(bim::read_plan_text(plan, "c").rooms.size(), 4U);
  const std::string text = read_text_file(folder_ / "c.yaml");
  const Scenario scenario = read_scenario(text, "c.yaml").scenario;
  EXPECT_EQ(scenario.building, "c.plan.yaml");
  EXPECT_EQ(scenario.start.room, "room_2");
  EXPECT_EQ(scenario.route.rooms.size(), 4U);
  EXPECT_EQ(run("corridor --rooms 4 -o c.plan.yaml"), 2);
  EXPECT_NE(said_.find("--force"), std::string::npos) << said_;
  EXPECT_EQ(read_text_file(folder_ / "c.plan.yaml"), plan);
  EXPECT_EQ(run("corridor --rooms 4 --force -o c.plan.yaml"), 0) << said_;
  ASSERT_EQ(run("corridor --rooms 3 -o -"), 0);
  EXPECT_EQ(said_, plan);
}

TEST_F(GenerateCommand, AFamilyMayBeWrittenAsIfc) {
  ASSERT_EQ(run("corridor --rooms 3 -o c.plan.yaml"), 0) << said_;
  ASSERT_EQ(run("corridor --rooms 3 -o c.ifc --scenario c.yaml"), 0) << said_;
  const bim::Building ifc = bim::load_building(folder_ / "c.ifc"), plan = bim::load_building(folder_ / "c.plan.yaml");
  EXPECT_EQ(ifc.walls.size(), plan.walls.size());
  ASSERT_EQ(ifc.rooms.size(), plan.rooms.size());
  const Scenario scenario = read_scenario(read_text_file(folder_ / "c.yaml"), "c.yaml").scenario;
  EXPECT_EQ(scenario.building, "c.ifc");
  for (const std::string& room : scenario.route.rooms)
    EXPECT_TRUE(std::any_of(ifc.rooms.begin(), ifc.rooms.end(), [&](const bim::Room& r) { return r.id == room; }))
        << room;
}

TEST_F(GenerateCommand, SaysWhatIsWrong) {
  EXPECT_EQ(run("corridr -o -"), 2);
  EXPECT_NE(said_.find("did you mean 'corridor'?"), std::string::npos) << said_;
  EXPECT_EQ(run("corridor --rooms many -o -"), 2);
  EXPECT_NE(said_.find("--rooms"), std::string::npos) << said_;
  EXPECT_EQ(run("corridor --widths 3 -o -"), 2);
  EXPECT_NE(said_.find("--widths"), std::string::npos) << said_;
  EXPECT_EQ(run("corridor"), 2);
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("grid --epsilon 0.3 -o -"), 2);
  EXPECT_NE(said_.find("needs a feature"), std::string::npos) << said_;
  EXPECT_EQ(run("grid --feature column -o -"), 2);
  EXPECT_NE(said_.find("needs a size"), std::string::npos) << said_;
  EXPECT_EQ(run("grid -o same.yaml --scenario ./same.yaml"), 2);
  EXPECT_NE(said_.find("is the plan's own file"), std::string::npos) << said_;
  EXPECT_EQ(run("grid -o . --force"), 2);
  EXPECT_NE(said_.find("is a directory"), std::string::npos) << said_;
  EXPECT_EQ(run("grid -o same.yaml --scenario none/x.yaml"), 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "same.yaml"));
}

TEST_F(GenerateCommand, FurnishesAFamily) {
  ASSERT_EQ(run("corridor --rooms 3 --furnish 0.2 --furnish-seed 4 -o c.plan.yaml --scenario c.yaml"), 0) << said_;
  const std::string plan = read_text_file(folder_ / "c.plan.yaml");
  EXPECT_EQ(plan.rfind("# Made by: plumbline generate corridor --rooms 3 --furnish 0.2 --furnish-seed 4\n", 0), 0U);
  const bim::Building building = bim::read_plan_text(plan, "c");
  EXPECT_GT(building.obstacles.size(), 8U);
  for (const bim::Obstacle& obstacle : building.obstacles) EXPECT_EQ(obstacle.kind, "furniture");
  ASSERT_EQ(run("corridor --rooms 3 --furnish 0.2 --furnish-seed 5 -o -"), 0);
  EXPECT_NE(said_, plan);
  EXPECT_EQ(run("corridor --furnish 0.5 -o -"), 2);
  EXPECT_NE(said_.find("0 to 0.4"), std::string::npos) << said_;
  EXPECT_EQ(run("corridor --furnish-seed 2 -o -"), 2);
}

TEST_F(GenerateCommand, FurnishesABuildingAsPlanAndAsIfc) {
  ASSERT_EQ(run("grid --rows 2 --columns 2 -o bare.plan.yaml"), 0) << said_;
  ASSERT_EQ(run("furnish bare.plan.yaml --furnish 0.2 --seed 3 --people 2 -o full.plan.yaml"), 0) << said_;
  const bim::Building bare = bim::load_building(folder_ / "bare.plan.yaml");
  const bim::Building full = bim::load_building(folder_ / "full.plan.yaml");
  EXPECT_TRUE(bare.obstacles.empty());
  EXPECT_GT(full.obstacles.size(), 8U);
  bim::Building emptied = full;
  emptied.obstacles.clear();
  EXPECT_EQ(emptied.hash(), bare.hash());
  EXPECT_NE(read_text_file(folder_ / "full.plan.yaml").find("shape: person"), std::string::npos);
  ASSERT_EQ(run("furnish bare.plan.yaml --furnish 0.2 --seed 3 --people 2 -o full.ifc"), 0) << said_;
  EXPECT_EQ(bim::load_building(folder_ / "full.ifc").hash(), full.hash());
  EXPECT_EQ(said_.find("people"), std::string::npos) << said_;
  ASSERT_EQ(run("furnish bare.plan.yaml --furnish 0.05 --people 50 -o crowd.plan.yaml"), 0);
  EXPECT_NE(said_.find("of the 50 people asked for sit"), std::string::npos) << said_;
  ASSERT_EQ(run("furnish full.ifc --furnish 0.1 -o fuller.ifc"), 0) << said_;
  EXPECT_GT(bim::load_building(folder_ / "fuller.ifc").obstacles.size(), full.obstacles.size());
  EXPECT_EQ(run("furnish full.ifc --furnish 0.1 -o fuller.plan.yaml"), 2);
  EXPECT_NE(said_.find("ends in .ifc"), std::string::npos) << said_;
  EXPECT_EQ(run("furnish bare.plan.yaml --furnish 0.1 -o full.ifc"), 2);
  EXPECT_NE(said_.find("--force"), std::string::npos) << said_;
  EXPECT_EQ(run("furnish bare.plan.yaml -o other.plan.yaml"), 2);
  EXPECT_EQ(run("furnish nothing.plan.yaml --furnish 0.1 -o other.plan.yaml"), 2);
}

}  // namespace
}  // namespace plumbline::scenarios
