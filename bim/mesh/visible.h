// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// Id of the material of an element, empty when it names none.
[[nodiscard]] const std::string& material_of(const Building& building, const MeshElement& element);

/// The mesh as a LiDAR sees it: without the triangles of elements of a transparent material (transmission of at
/// least see_through_share), such as window panes. Elements keep their ids; those left out have no triangles.
[[nodiscard]] BuildingMesh visible_mesh(const Building& building, const BuildingMesh& mesh);

}  // namespace plumbline::bim
