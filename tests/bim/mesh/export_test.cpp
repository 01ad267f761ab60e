// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/export.h"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <filesystem>

#include "bim/building/plan_yaml.h"
#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::bim {
namespace {

BuildingMesh two_walls() {
  return build_mesh(
      read_plan_text("plan: 1\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\n"
                     "walls:\n"
                     "  - {id: first, storey: g, a: [0, 0], b: [4, 0], thickness_m: 0.2}\n"
                     "  - {id: second, storey: g, a: [0, 5], b: [3, 5], thickness_m: 0.3}\n",
                     "two.plan.yaml"));
}

class ExportTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("plumbline_export" + std::string(GetParam()).substr(1));
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "out").string() + GetParam();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  std::string path_;
};

/// Six times the volume under a mesh, summed over its triangles.
double six_volumes(const aiMesh& mesh, const aiMatrix4x4& X) {
  double six = 0.0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const auto p = [&](unsigned k) {
      const aiVector3D v = X * mesh.mVertices[mesh.mFaces[f].mIndices[k]];
      return Eigen::Vector3d(v.x, v.y, v.z);
    };
    six += p(0).dot(p(1).cross(p(2)));
  }
  return six;
}

TEST_P(ExportTest, ComesBackWithItsTrianglesAndVolume) {
  const BuildingMesh mesh = two_walls();
  write_mesh(mesh, path_);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path_, 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  unsigned triangles = 0;
  double volume = 0.0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    triangles += scene->mMeshes[i]->mNumFaces;
    volume += six_volumes(*scene->mMeshes[i], aiMatrix4x4()) / 6.0;
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  double expected = 0.0;
  for (const MeshElement& element : mesh.elements) expected += element.volume_m3;
  EXPECT_NEAR(volume, expected, 1e-4);  // vertices are floats
}

TEST_P(ExportTest, WritesTheSameBytesTwiceAndNothingElse) {
  write_mesh(two_walls(), path_);
  const std::string first = read_text_file(path_);
  write_mesh(two_walls(), path_);
  EXPECT_EQ(read_text_file(path_), first);
  const auto files = std::distance(std::filesystem::directory_iterator(folder_), {});
  EXPECT_EQ(files, 1);
}

TEST_P(ExportTest, UnwritablePlaceIsAnEnvironmentError) {
  const std::string path = (folder_ / "no such folder" / "out").string() + GetParam();
  EXPECT_THROW(write_mesh(two_walls(), path), EnvironmentError);
}

INSTANTIATE_TEST_SUITE_P(Formats, ExportTest, testing::Values(".glb", ".obj", ".ply"),
                         [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param + 1); });

TEST(Export, GlbHasOneNodeAnElementAndYUp) {
  const std::string path = testing::TempDir() + "plumbline_nodes.glb";
  write_mesh(two_walls(), path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  ASSERT_NE(scene, nullptr);
  for (const char* id : {"first", "second"}) EXPECT_NE(scene->mRootNode->FindNode(id), nullptr) << id;
  const aiVector3D up = scene->mRootNode->mTransformation * aiVector3D(0, 0, 1);
  EXPECT_NEAR(up.y, 1.0, 1e-6);
  std::filesystem::remove(path);
}

TEST(Export, OtherEndingsAreRefused) {
  EXPECT_THROW(write_mesh(two_walls(), testing::TempDir() + "mesh.stl"), InputError);
  EXPECT_THROW(write_mesh({}, testing::TempDir() + "mesh.glb"), InputError);
}

}  // namespace
}  // namespace plumbline::bim
