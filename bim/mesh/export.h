// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

enum class MeshFormat { glb, obj, ply };

/// The format of a file by its ending. Throws InputError for any other than .glb, .obj and .ply.
[[nodiscard]] MeshFormat mesh_format(const std::string& path);

/// The mesh as the bytes of a file. Frame W, m, z up; .glb is turned to the y up that glTF asks for. In .glb and .obj
/// each element is a node named by its id (line breaks become blanks); .ply has but one mesh. .glb and .ply are
/// coloured by what an element is, glass lets light through in .glb. The same mesh gives the same bytes. Throws
/// InputError when there is no triangle.
[[nodiscard]] std::string write_mesh(const Building& building, const BuildingMesh& mesh, MeshFormat format);

}  // namespace plumbline::bim
