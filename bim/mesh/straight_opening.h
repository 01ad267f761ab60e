// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/mesh/wall_cut.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

/// Whether solids go through a wall, whose faces lie at the ends of y, as their silhouette does: together they reach
/// both faces, and have the same section at every depth between. Splayed, skew and stepped ones do not. Of solids that
/// do not close, which have no section, the reach alone counts.
[[nodiscard]] bool goes_straight_through(const std::vector<Solid>& solids, const WallFrame& frame, const Interval& y,
                                         const MeshConfig& config);

}  // namespace plumbline::bim
