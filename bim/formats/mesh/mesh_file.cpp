// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <cstring>
#include <map>

#include "bim/config/file_ending.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/mesh/ply_check.h"

namespace plumbline::bim {

namespace {

struct Format {
  std::string_view ending;
  bool y_up;
};
constexpr std::array<Format, 5> formats{
    {{".obj", false}, {".dae", true}, {".glb", true}, {".ply", false}, {".stl", false}}};

/// The format of a path, or nullptr.
const Format* format_of(std::string_view path) {
  for (const Format& format : formats)
    if (has_ending(path, format.ending)) return &format;
  return nullptr;
}

/// Plain values one after the other: how the parts come through the pipe.
class Packer {
 public:
  template <class T>
  void put(const T* values, std::size_t count) {
    text_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  void put(std::uint64_t value) { put(&value, 1); }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view text) : text_(text) {}

  template <class T>
  void get(T* values, std::size_t count) {
    if (text_.size() / sizeof(T) < count) throw InternalError("the answer of the mesh reader's process is too short");
    if (count > 0) std::memcpy(values, text_.data(), count * sizeof(T));
    text_.remove_prefix(count * sizeof(T));
  }
  std::uint64_t get() {
    std::uint64_t value = 0;
    get(&value, 1);
    return value;
  }
  /// A count of items of so many bytes each, which the file must hold.
  std::size_t count(std::size_t bytes) {
    const std::uint64_t value = get();
    if (value > text_.size() / bytes) throw InternalError("the answer of the mesh reader's process is too short");
    return static_cast<std::size_t>(value);
  }

 private:
  std::string_view text_;
};

/// What the child found; the rest of the answer is a text or the parts.
enum class Answer : std::uint64_t { parts, refused, too_large };

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const MeshFileConfig& config) : scene_(scene), config_(config) {}

  /// False when a bound is passed.
  bool read(const aiMatrix4x4& X_Wroot) {
    // Depth first with a stack of its own: a file may nest as deep as it likes.
    std::vector<std::pair<const aiNode*, aiMatrix4x4>> stack = {{scene_.mRootNode, X_Wroot}};
    while (!stack.empty()) {
      const auto [node, X_Wparent] = stack.back();
      stack.pop_back();
      const aiMatrix4x4 X_Wnode = X_Wparent * node->mTransformation;
      if (!add(*node, X_Wnode)) return false;
      for (unsigned i = node->mNumChildren; i > 0; --i) stack.emplace_back(node->mChildren[i - 1], X_Wnode);
    }
    return true;
  }

  [[nodiscard]] std::string packed() {
    Packer packer;
    packer.put(static_cast<std::uint64_t>(Answer::parts));
    packer.put(parts_.size());
    for (const MeshPart& part : parts_) {
      packer.put(part.name.size());
      packer.put(part.name.data(), part.name.size());
      packer.put(part.solid.vertices.size());
      for (const Eigen::Vector3d& p : part.solid.vertices) packer.put(p.data(), 3);
      packer.put(part.solid.triangles.size());
      for (const Eigen::Vector3i& t : part.solid.triangles) packer.put(t.data(), 3);
    }
    return packer.take();
  }

 private:
  bool add(const aiNode& node, const aiMatrix4x4& X_Wnode) {
    MeshPart part;
    part.name = node.mName.C_Str();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      if (node.mNumMeshes == 1 && part.name.empty()) part.name = mesh.mName.C_Str();
      vertices_ += mesh.mNumVertices;
      triangles_ += mesh.mNumFaces;
      if (vertices_ > config_.most_vertices || triangles_ > config_.most_triangles) return false;
      add(mesh, X_Wnode, part.solid);
    }
    if (!part.solid.triangles.empty()) parts_.push_back(std::move(part));
    return true;
  }

  static void add(const aiMesh& mesh, const aiMatrix4x4& X_Wnode, Solid& solid) {
    const int first = static_cast<int>(solid.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = X_Wnode * mesh.mVertices[v];
      solid.vertices.emplace_back(p.x, p.y, p.z);
    }
    // A transform that mirrors turns every triangle over.
    const bool mirrors = X_Wnode.Determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      Eigen::Vector3i t(static_cast<int>(face.mIndices[0]), static_cast<int>(face.mIndices[1]),
                        static_cast<int>(face.mIndices[2]));
      if (mirrors) std::swap(t[1], t[2]);
      if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(mesh.mNumVertices)) continue;
      solid.triangles.emplace_back(t.array() + first);
    }
  }

  const aiScene& scene_;
  const MeshFileConfig& config_;
  std::vector<MeshPart> parts_;
  std::size_t vertices_ = 0, triangles_ = 0;
};

std::string other_answer(Answer answer, const std::string& text) {
  Packer packer;
  packer.put(static_cast<std::uint64_t>(answer));
  packer.put(text.data(), text.size());
  return packer.take();
}

/// Runs in the child.
std::string import(std::string_view bytes, const Format& format, const MeshFileConfig& config) {
  Assimp::Importer importer;
  // Points and lines come as meshes of their own and are dropped.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_ValidateDataStructure,
      std::string(format.ending.substr(1)).c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) return other_answer(Answer::refused, importer.GetErrorString());
  // (x, y, z) to (x, -z, y).
  const aiMatrix4x4 X_Wroot =
      format.y_up ? aiMatrix4x4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1) : aiMatrix4x4();
  SceneReader reader(*scene, config);
  return reader.read(X_Wroot) ? reader.packed() : other_answer(Answer::too_large, {});
}

std::string answer_of_child(std::string_view bytes, const Format& format, const Mark& mark,
                            const MeshFileConfig& config) {
  const SubprocessLimits limits = subprocess_limits(bytes.size(), config.subprocess);
  SubprocessResult result = run_in_subprocess([&] { return import(bytes, format, config); }, limits);
  if (result.answer) return *std::move(result.answer);
  if (result.end == SubprocessEnd::out_of_wall_time)
    throw EnvironmentError(to_string(mark) + ": reading it took more than " + format_number(limits.wall_s) +
                           " s, but less than " + std::to_string(limits.cpu_s) +
                           " s of a processor: this machine is busy; try again when it is less so");
  if (result.end == SubprocessEnd::out_of_cpu_time)
    throw InputError(mark, "reading it takes more than " + std::to_string(limits.cpu_s) +
                               " s of a processor, the most for a file of its size; make it coarser, or write it anew");
  throw InputError(mark, "this is not a valid " + std::string(format.ending) +
                             " file: reading it failed, or takes more than " + std::to_string(limits.memory >> 20U) +
                             " MB of memory");
}

std::vector<MeshPart> unpacked(Unpacker& unpacker) {
  std::vector<MeshPart> parts(unpacker.count(3 * sizeof(std::uint64_t)));
  for (MeshPart& part : parts) {
    part.name.resize(unpacker.count(1));
    unpacker.get(part.name.data(), part.name.size());
    part.solid.vertices.resize(unpacker.count(3 * sizeof(double)));
    for (Eigen::Vector3d& p : part.solid.vertices) unpacker.get(p.data(), 3);
    part.solid.triangles.resize(unpacker.count(3 * sizeof(int)));
    for (Eigen::Vector3i& t : part.solid.triangles) unpacker.get(t.data(), 3);
  }
  return parts;
}

/// What a name in a report may hold.
std::string ascii(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '_';
  return name;
}

/// assimp's reason, without the name it gives to what lies in memory and without those of the library's exceptions.
std::string reason(const std::string& text) {
  if (text.find("$$$") != std::string::npos) return "it holds something else";
  const bool exception = text.find("::") != std::string::npos || text.starts_with("sto");
  return exception ? "its content is damaged" : ascii(text);
}

void make_names_unique(std::vector<MeshPart>& parts) {
  std::map<std::string, int> uses;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string& name = parts[i].name;
    name = name.empty() ? "part" + std::to_string(i + 1) : ascii(name);
    std::string unique = name;
    while (uses.contains(unique)) unique = name + "#" + std::to_string(++uses[name]);
    uses[unique] = 1;
    name = unique;
  }
}

void check_coordinates(const std::vector<MeshPart>& parts, const std::string& path, double furthest) {
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3d& p : part.solid.vertices)
      if (!(p.cwiseAbs().maxCoeff() <= furthest))
        throw InputError({path, 0, 0}, "'" + part.name + "' reaches further than " + format_number(furthest) +
                                           " units of the file or is not a number");
}

}  // namespace

Eigen::AlignedBox3d box_of(const std::vector<MeshPart>& parts) {
  Eigen::AlignedBox3d box;
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3i& t : part.solid.triangles)
      for (int k = 0; k < 3; ++k) box.extend(part.solid.vertices[static_cast<std::size_t>(t[k])]);
  return box;
}

bool says_its_axes(std::string_view path) {
  const Format* format = format_of(path);
  return format != nullptr && format->y_up;
}

bool is_mesh_path(std::string_view path) { return format_of(path) != nullptr; }

std::vector<MeshPart> read_mesh_parts(std::string_view bytes, const std::string& path, const MeshFileConfig& config) {
  const Format* format = format_of(path);
  if (format == nullptr) throw InputError({path, 0, 0}, "a mesh is a .obj, .dae, .glb, .ply or .stl file");
  const Mark mark{path, 0, 0};
  if (bytes.size() > config.most_bytes)
    throw InputError(mark, "larger than " + std::to_string(config.most_bytes >> 20U) + " MB; make it coarser");
  if (format->ending == ".ply") check_ply(bytes, path);
  const std::string answer = answer_of_child(bytes, *format, mark, config);
  Unpacker unpacker(answer);
  const auto kind = static_cast<Answer>(unpacker.get());
  if (kind == Answer::refused)
    throw InputError(mark, "this is not a valid " + std::string(format->ending) +
                               " file: " + reason(answer.substr(sizeof(std::uint64_t))));
  if (kind == Answer::too_large)
    throw InputError(mark, "more than " + std::to_string(config.most_triangles) + " triangles or " +
                               std::to_string(config.most_vertices) + " vertices; make it coarser");
  std::vector<MeshPart> parts = unpacked(unpacker);
  if (parts.empty()) throw InputError(mark, "no triangle in it; a world needs some to stand on");
  make_names_unique(parts);
  check_coordinates(parts, path, config.furthest);
  return parts;
}

}  // namespace plumbline::bim
