// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/mesh/mesh_file.h"
#include "scenarios/app/commands.h"
#include "tests/folder.h"

namespace plumbline::scenarios {
namespace {

class InspectCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(plan_) << "plan: 1\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\n"
                            "walls: [{id: w, storey: g, a: [0, 0], b: [4, 0], thickness_m: 0.2}]\n";
  }

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

  const Folder folder_;
  const std::string plan_ = folder_ / "wall.plan.yaml";
};

TEST_F(InspectCommandTest, PrintsJsonThatReadsBack) {
  const Tree tree = read_json(run({plan_, "--json"}), "stdout");
  EXPECT_EQ(tree.find("walls")->as_list().size(), 1u);
  EXPECT_EQ(tree.find("schema")->as_string(), "plan");
}

TEST_F(InspectCommandTest, WritesTheMeshAskedForAndNothingElse) {
  const std::string mesh = folder_ / "wall.glb";
  EXPECT_NE(run({plan_, "--mesh", mesh}).find("1 walls"), std::string::npos);
  const std::vector<bim::MeshPart> parts = bim::read_mesh_parts(read_text_file(mesh), mesh);
  std::vector<Eigen::Vector3d> sizes;
  for (const bim::MeshPart& part : parts) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : part.solid.vertices) box.extend(p);
    sizes.emplace_back(box.sizes());
  }
  const Eigen::Vector3d wall(4.0, 0.2, 3.0);  // of the plan
  const auto is_wall = [&](const Eigen::Vector3d& size) { return (size - wall).norm() < 1e-6; };
  EXPECT_EQ(std::count_if(sizes.begin(), sizes.end(), is_wall), 1);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(InspectCommandTest, MissingFileIsAnInputError) { EXPECT_THROW(run({folder_ / "no.ifc"}), InputError); }

}  // namespace
}  // namespace plumbline::scenarios
