// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// Joins coplanar faces that stand at height band_z into lines where a scan cannot tell the gap from a door, and writes
/// each segment's line. Lines are ordered by their first segment; lintels and sills stay without one.
[[nodiscard]] std::vector<WallLine> merge_wall_lines(std::vector<PlanSegment>& segments, double band_z,
                                                     const PlanIndexConfig& config);

}  // namespace plumbline::slam
