// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/mesh.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// A storey of the plan as triangles in I: faces without their holes (one element each, in the order of the segments),
/// then a floor and a ceiling under and over all of them. What stands in holes, and jambs, are not in a plan.
[[nodiscard]] bim::BuildingMesh plan_mesh(const StoreyIndex& storey);

}  // namespace plumbline::slam
