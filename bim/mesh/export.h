// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// Writes the mesh as .glb, .obj or .ply, told by the ending of `path`, one node an element, named by its id. Frame W,
/// m, z up; .glb is turned to the y up that glTF asks for. The file appears complete or not at all. Throws InputError
/// for another ending, EnvironmentError when the file cannot be written.
void write_mesh(const BuildingMesh& mesh, const std::string& path);

}  // namespace plumbline::bim
