// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/mesh/mesh.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// The segments of a storey as triangles in I: faces without their holes (elements are called by the first segment, as
/// PlanSegment::element does), then a floor and a ceiling under and over all of them. What stands in holes, and jambs,
/// are not in it.
[[nodiscard]] bim::BuildingMesh plan_mesh(const StoreyIndex& storey);

}  // namespace plumbline::slam
