// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"

namespace plumbline::scenarios {
namespace {

class InspectCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::ofstream(plan_) << "plan: 1\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\n"
                            "walls: [{id: w, storey: g, a: [0, 0], b: [4, 0], thickness_m: 0.2}]\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string run(const std::vector<std::string>& arguments) {
    CommandLine program("", "plumbline");
    Command command = add_inspect(program);
    std::vector<std::string> all = {"inspect"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    EXPECT_TRUE(program.parse(all));
    testing::internal::CaptureStdout();
    int code = -1;
    try {
      code = command.action();
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    EXPECT_EQ(code, 0);
    return testing::internal::GetCapturedStdout();
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("plumbline_inspect_command_" + std::to_string(getpid()));
  const std::string plan_ = (folder_ / "wall.plan.yaml").string();
};

TEST_F(InspectCommandTest, PrintsJsonThatReadsBack) {
  const Tree tree = read_json(run({plan_, "--json"}), "stdout");
  EXPECT_EQ(tree.find("walls")->as_list().size(), 1u);
  EXPECT_EQ(tree.find("schema")->as_string(), "plan");
}

TEST_F(InspectCommandTest, WritesTheMeshAskedForAndNothingElse) {
  const std::string mesh = (folder_ / "wall.glb").string();
  EXPECT_NE(run({plan_, "--mesh", mesh}).find("1 walls"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(mesh), 100u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 2);
}

TEST_F(InspectCommandTest, MissingFileIsAnInputError) {
  EXPECT_THROW(run({(folder_ / "no.ifc").string()}), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
