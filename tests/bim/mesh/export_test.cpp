// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/export.h"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"

namespace plumbline::bim {
namespace {

Building office() {
  return read_plan_text(
      "plan: 1\nstoreys: [{id: g, elevation_m: 0, height_m: 3}]\n"
      "walls:\n"
      "  - {id: first, storey: g, a: [0, 0], b: [4, 0], thickness_m: 0.2}\n"
      "  - {id: zweite Wand, storey: g, a: [0, 5], b: [3, 5], thickness_m: 0.3}\n"
      "columns: [{id: Stütze 'A', storey: g, at: [2, 2], size: [0.3, 0.3]}]\n"
      "clutter: [{id: desk, storey: g, shape: box, at: [1, 3], size: [1, 1], height_m: 0.7}]\n",
      "office.plan.yaml");
}

/// The office written and taken back by assimp.
class ExportTest : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string bytes() const {
    return write_mesh(building_, mesh_, mesh_format(std::string("out.") + GetParam()));
  }
  const aiScene* read(const std::string& text) {
    const aiScene* scene = importer_.ReadFileFromMemory(text.data(), text.size(), 0, GetParam());
    EXPECT_NE(scene, nullptr) << importer_.GetErrorString();
    return scene;
  }

  Building building_ = office();
  BuildingMesh mesh_ = build_mesh(building_);
  Assimp::Importer importer_;
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
  const std::string text = bytes();
  const aiScene* scene = read(text);
  ASSERT_NE(scene, nullptr);
  unsigned triangles = 0;
  double volume = 0.0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    triangles += scene->mMeshes[i]->mNumFaces;
    volume += six_volumes(*scene->mMeshes[i], aiMatrix4x4()) / 6.0;
  }
  EXPECT_EQ(triangles, mesh_.triangles.size());
  double expected = 0.0;
  for (const MeshElement& element : mesh_.elements) expected += element.volume_m3;
  EXPECT_NEAR(volume, expected, 1e-4);  // vertices are floats
}

TEST_P(ExportTest, WritesTheSameBytesTwice) { EXPECT_EQ(bytes(), bytes()); }

INSTANTIATE_TEST_SUITE_P(Formats, ExportTest, testing::Values("glb", "obj", "ply"),
                         [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param); });

class NodesTest : public ExportTest {};

TEST_P(NodesTest, OneAnElementWithItsTriangles) {
  const std::string text = bytes();
  const aiScene* scene = read(text);
  ASSERT_NE(scene, nullptr);
  EXPECT_EQ(scene->mRootNode->mNumChildren, mesh_.elements.size());
  for (const MeshElement& element : mesh_.elements) {
    const aiNode* node = scene->mRootNode->FindNode(element.id.c_str());
    ASSERT_NE(node, nullptr) << element.id;
    ASSERT_EQ(node->mNumMeshes, 1u) << element.id;
    EXPECT_EQ(static_cast<int>(scene->mMeshes[node->mMeshes[0]]->mNumFaces), element.triangle_count) << element.id;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, NodesTest, testing::Values("glb", "obj"),
                         [](const testing::TestParamInfo<const char*>& info) { return std::string(info.param); });

class GlbTest : public ExportTest {};

TEST_P(GlbTest, HasYUp) {
  const std::string text = bytes();
  const aiScene* scene = read(text);
  ASSERT_NE(scene, nullptr);
  const aiVector3D up = scene->mRootNode->mTransformation * aiVector3D(0, 0, 1);
  EXPECT_NEAR(up.y, 1.0, 1e-6);
}

TEST_P(GlbTest, ColoursTellWhatAnElementIs) {
  building_.obstacles[0].material = "glass";
  const std::string text = bytes();
  const aiScene* scene = read(text);
  ASSERT_NE(scene, nullptr);
  const auto material = [&](const char* id) -> const aiMaterial& {
    return *scene->mMaterials[scene->mMeshes[scene->mRootNode->FindNode(id)->mMeshes[0]]->mMaterialIndex];
  };
  EXPECT_STREQ(material("first").GetName().C_Str(), "wall");
  EXPECT_STREQ(material("zweite Wand").GetName().C_Str(), "wall");
  EXPECT_STREQ(material("Stütze 'A'").GetName().C_Str(), "column");
  EXPECT_STREQ(material("desk").GetName().C_Str(), "glass");
  aiColor4D glass;
  ASSERT_EQ(material("desk").Get(AI_MATKEY_BASE_COLOR, glass), AI_SUCCESS);
  EXPECT_NEAR(glass.a, 0.35F, 1e-6F);
  aiString mode;
  ASSERT_EQ(material("desk").Get("$mat.gltf.alphaMode", 0, 0, mode), AI_SUCCESS);
  EXPECT_STREQ(mode.C_Str(), "BLEND");
}

INSTANTIATE_TEST_SUITE_P(Format, GlbTest, testing::Values("glb"));

TEST(Export, LineBreaksInIdsDoNotBreakTheFile) {
  Building building = office();
  building.walls[0].id = "two\nlines";
  const BuildingMesh mesh = build_mesh(building);
  const std::string text = write_mesh(building, mesh, MeshFormat::obj);
  EXPECT_NE(text.find("g two lines"), std::string::npos);
}

TEST(Export, OtherEndingsAreRefused) {
  for (const char* path : {"mesh.stl", "mesh", "mesh.glb.txt", ""}) EXPECT_THROW((void)mesh_format(path), InputError);
  EXPECT_THROW((void)write_mesh(office(), {}, MeshFormat::glb), InputError);
}

}  // namespace
}  // namespace plumbline::bim
