// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/plan/plan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// Fronts of planned furniture that are long and tall enough for a scan to show them as walls, as shelves in a
/// warehouse do, also of pieces that are mostly air. In I, for a storey whose floor and ceiling are at these heights.
[[nodiscard]] std::vector<WallLine> furniture_rows(const bim::Plan& plan_W, const Pose& X_WI, double floor_z,
                                                   double ceiling_z, const PlanIndexConfig& config);

}  // namespace plumbline::slam
