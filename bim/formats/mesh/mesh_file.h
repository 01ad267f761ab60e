// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bim/formats/mesh/subprocess.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Bounds of a mesh that is read.
struct MeshFileConfig {
  std::size_t most_bytes = std::size_t{1} << 28U;
  std::size_t most_triangles = 3'000'000;
  std::size_t most_vertices = 6'000'000;
  SubprocessLimits subprocess;
  double furthest = 1e6;  ///< coordinates beyond this, in the file's unit, are refused
};

/// One node of a mesh file with its own triangles.
struct MeshPart {
  std::string name;  ///< unique in its file
  Solid solid;
};

/// True for the endings .obj, .dae, .glb, .ply and .stl.
[[nodiscard]] bool is_mesh_path(std::string_view path);

/// Box around all triangles.
[[nodiscard]] Eigen::AlignedBox3d box_of(const std::vector<MeshPart>& parts);

/// Whether files of this kind say which axis is up, by the ending of their path; glTF and Collada do.
[[nodiscard]] bool says_its_axes(std::string_view path);

/// Reads a mesh by assimp, in a subprocess, since it does not survive every bad file. `bytes` is the file's content,
/// `path` gives its kind and names it in errors. One part a node that has triangles, in the order of the file's tree;
/// points and lines are left out. glTF and Collada are turned from their y up; the others say nothing of their axes
/// and come as they stand, in the unit of the file (settle_axes). Throws InputError when it is none, has no triangle or
/// passes a bound, EnvironmentError when the machine had no time to read it.
[[nodiscard]] std::vector<MeshPart> read_mesh_parts(std::string_view bytes, const std::string& path,
                                                    const MeshFileConfig& config = {});

}  // namespace plumbline::bim
