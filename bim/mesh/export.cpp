// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/export.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <memory>
#include <string_view>

#include "bim/config/file_ending.h"
#include "bim/errors.h"
#include "bim/mesh/palette.h"

namespace plumbline::bim {
namespace {

struct Format {
  std::string_view ending;
  MeshFormat format;
  const char* assimp_id;
};
constexpr std::array<Format, 3> formats{
    {{".glb", MeshFormat::glb, "glb2"}, {".obj", MeshFormat::obj, "objnomtl"}, {".ply", MeshFormat::ply, "ply"}}};

/// Formats of lines cannot hold a name with a line break.
std::string node_name(std::string id) {
  std::replace_if(
      id.begin(), id.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return id;
}

/// The triangles of one element with their own vertices. The scene owns what it is given.
aiMesh* mesh_of(const BuildingMesh& mesh, const MeshElement& element) {
  auto result = std::make_unique<aiMesh>();
  const auto count = static_cast<unsigned>(element.triangle_count);
  result->mName = aiString(node_name(element.id));
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mNumVertices = 3 * count;
  result->mVertices = new aiVector3D[result->mNumVertices];
  result->mNumFaces = count;
  result->mFaces = new aiFace[count];
  for (unsigned i = 0; i < count; ++i) {
    const Eigen::Vector3i& t = mesh.triangles[static_cast<std::size_t>(element.first_triangle) + i];
    aiFace& face = result->mFaces[i];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    for (unsigned k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(t[static_cast<int>(k)])];
      result->mVertices[3 * i + k] =
          aiVector3D(static_cast<ai_real>(p.x()), static_cast<ai_real>(p.y()), static_cast<ai_real>(p.z()));
      face.mIndices[k] = 3 * i + k;
    }
  }
  return result.release();
}

aiMaterial* material_of(const Colour& entry) {
  auto result = std::make_unique<aiMaterial>();
  const aiString name{std::string(entry.name)};
  const aiColor4D colour(entry.red, entry.green, entry.blue, 1.0F);  // assimp multiplies it by the opacity
  const float metal = 0.0F, rough = 0.9F;
  result->AddProperty(&name, AI_MATKEY_NAME);
  result->AddProperty(&colour, 1, AI_MATKEY_BASE_COLOR);
  result->AddProperty(&metal, 1, AI_MATKEY_METALLIC_FACTOR);
  result->AddProperty(&rough, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  if (entry.opacity < 1.0F) result->AddProperty(&entry.opacity, 1, AI_MATKEY_OPACITY);
  return result.release();
}

void colour_vertices(aiMesh& mesh, const Colour& entry) {
  mesh.mColors[0] = new aiColor4D[mesh.mNumVertices];
  std::fill_n(mesh.mColors[0], mesh.mNumVertices, aiColor4D(entry.red, entry.green, entry.blue, entry.opacity));
}

void add_materials(aiScene& scene) {
  scene.mMaterials = new aiMaterial*[palette().size()];
  for (const Colour& entry : palette()) scene.mMaterials[scene.mNumMaterials++] = material_of(entry);
}

std::unique_ptr<aiScene> scene_of(const Building& building, const BuildingMesh& mesh, MeshFormat format) {
  std::vector<const MeshElement*> elements;
  for (const MeshElement& element : mesh.elements)
    if (element.triangle_count > 0) elements.push_back(&element);
  auto scene = std::make_unique<aiScene>();
  add_materials(*scene);
  scene->mRootNode = new aiNode("building");
  // (x, y, z) to (x, z, -y).
  if (format == MeshFormat::glb)
    scene->mRootNode->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  scene->mMeshes = new aiMesh*[elements.size()];
  std::vector<aiNode*> nodes;
  for (const MeshElement* element : elements) {
    aiNode* node = new aiNode(node_name(element->id));
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{scene->mNumMeshes};
    aiMesh* part = mesh_of(mesh, *element);
    const std::size_t entry = colour_of(building, *element);
    part->mMaterialIndex = static_cast<unsigned>(entry);
    if (format == MeshFormat::ply) colour_vertices(*part, palette()[entry]);
    scene->mMeshes[scene->mNumMeshes++] = part;
    nodes.push_back(node);
  }
  scene->mRootNode->addChildren(static_cast<unsigned>(nodes.size()), nodes.data());
  return scene;
}

}  // namespace

MeshFormat mesh_format(const std::string& path) {
  for (const Format& format : formats)
    if (has_ending(path, format.ending)) return format.format;
  throw InputError({path, 0, 0}, "a mesh is written as .glb, .obj or .ply");
}

std::string write_mesh(const Building& building, const BuildingMesh& mesh, MeshFormat format) {
  if (mesh.triangles.empty()) throw InputError({}, "the building has no triangle to write");
  const auto* entry =
      std::find_if(formats.begin(), formats.end(), [&](const Format& known) { return known.format == format; });
  const std::unique_ptr<aiScene> scene = scene_of(building, mesh, format);
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), entry->assimp_id, 0u);
  if (blob == nullptr)
    throw EnvironmentError(std::string("assimp cannot write the mesh: ") + exporter.GetErrorString());
  return {static_cast<const char*>(blob->data), blob->size};
}

}  // namespace plumbline::bim
