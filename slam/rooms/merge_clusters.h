// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// Clusters that a pilaster, a fin or a cupboard parts, made one: those that touch between the same two opposed walls,
/// over at least config.joined_share of the width between them, or config.passed_share beside what is thicker than a
/// wall. In the clusters' order, each at the position of its first.
[[nodiscard]] std::vector<Cluster> merge_clusters(const FreeGrid& grid, std::span<const Cluster> clusters,
                                                  std::span<const FaceLine> faces, const RoomConfig& config);

/// Clusters that touch over more than this length made one, without those that touch no other so.
[[nodiscard]] std::vector<Cluster> merge_wide(const FreeGrid& grid, std::span<const Cluster> clusters,
                                              double wider_than_m);

}  // namespace plumbline::slam
