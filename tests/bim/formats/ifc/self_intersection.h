// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// True when two triangles of an element meet anywhere but in their common vertices and edges (CGAL, exact predicates).
[[nodiscard]] bool intersects_itself(const BuildingMesh& mesh, const MeshElement& element);

}  // namespace plumbline::bim
