// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// Straight edges of a cluster's free space along `axis`, unit, or across it: where it ends at a wall that was seen in
/// too few scans for a plane. Longest first (ties: in the order axis, -axis, across, -across, then by offset), none
/// beside a longer one; id -1.
[[nodiscard]] std::vector<FaceLine> straight_edges(const ClusterWalls& cluster_walls, const Eigen::Vector2d& axis);

}  // namespace plumbline::slam
