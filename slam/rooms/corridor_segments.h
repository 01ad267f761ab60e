// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// The straight segments of a cluster that is a bent corridor or runs in a ring: again and again the largest stretch
/// between two opposed walls that is mostly free, until no more is left between opposed walls. Corners go to the part
/// that is found first. Parts below min_part_m2 are left out.
[[nodiscard]] std::vector<Cluster> corridor_segments(const ClusterWalls& cluster_walls);

}  // namespace plumbline::slam
