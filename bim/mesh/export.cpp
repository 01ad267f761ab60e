// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/export.h"

#include <assimp/scene.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <assimp/Exporter.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include "bim/errors.h"

namespace plumbline::bim {
namespace {

struct Format {
  std::string_view ending;
  const char* assimp_id;
  bool y_up;
};
constexpr std::array<Format, 3> formats{{{".glb", "glb2", true}, {".obj", "objnomtl", false}, {".ply", "ply", false}}};

const Format& format_of(const std::string& path) {
  for (const Format& format : formats)
    if (path.ends_with(format.ending)) return format;
  throw InputError({path, 0, 0}, "a mesh is written as .glb, .obj or .ply");
}

/// The triangles of one element with their own vertices. The scene owns what it is given.
aiMesh* mesh_of(const BuildingMesh& mesh, const MeshElement& element) {
  auto result = std::make_unique<aiMesh>();
  const auto count = static_cast<unsigned>(element.triangle_count);
  result->mName = aiString(element.id);
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

std::unique_ptr<aiScene> scene_of(const BuildingMesh& mesh, bool y_up) {
  std::vector<const MeshElement*> elements;
  for (const MeshElement& element : mesh.elements)
    if (element.triangle_count > 0) elements.push_back(&element);
  auto scene = std::make_unique<aiScene>();
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mRootNode = new aiNode("building");
  // (x, y, z) to (x, z, -y).
  if (y_up) scene->mRootNode->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  scene->mMeshes = new aiMesh*[elements.size()];
  std::vector<aiNode*> nodes;
  for (const MeshElement* element : elements) {
    aiNode* node = new aiNode(element->id);
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{scene->mNumMeshes};
    scene->mMeshes[scene->mNumMeshes++] = mesh_of(mesh, *element);
    nodes.push_back(node);
  }
  scene->mRootNode->addChildren(static_cast<unsigned>(nodes.size()), nodes.data());
  return scene;
}

void write_atomically(const std::string& path, const void* data, std::size_t size) {
  const std::string temporary = path + ".part";
  const auto fail = [&](const char* what) {
    const std::string reason = std::strerror(errno);
    std::remove(temporary.c_str());
    throw EnvironmentError(path + ": cannot " + what + ": " + reason);
  };
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail("create");
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(file, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      ::close(file);
      errno = reason;
      fail("write");
    }
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  const bool synced = ::fsync(file) == 0;
  if (::close(file) != 0 || !synced) fail("write");
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("rename");
}

}  // namespace

void write_mesh(const BuildingMesh& mesh, const std::string& path) {
  const Format& format = format_of(path);
  if (mesh.triangles.empty()) throw InputError({path, 0, 0}, "the building has no triangle to write");
  const std::unique_ptr<aiScene> scene = scene_of(mesh, format.y_up);
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), format.assimp_id, 0u);
  if (blob == nullptr) throw EnvironmentError(path + ": assimp cannot export it: " + exporter.GetErrorString());
  write_atomically(path, blob->data, blob->size);
}

}  // namespace plumbline::bim
