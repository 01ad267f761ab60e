// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/plan/plan.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam::ros {

/// A building as viewers of bags show it.
struct BuildingView {
  std::vector<Triangles> parts;  ///< by kind of element
  Grid plan;                     ///< of one storey; without cells where it has no rooms
};

/// Triangles of the mesh by kind, and the plan of a storey: what the mesh has 1.2 m above its floor is
/// occupied, the rest of its rooms free, and outside of them unknown. storey < 0: no plan. A plan of more than 16
/// million cells is left out.
[[nodiscard]] BuildingView building_view(const bim::BuildingMesh& mesh, const bim::Plan& plan, int storey);

}  // namespace plumbline::slam::ros
