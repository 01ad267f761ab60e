// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// The rooms of an open plan that one cluster holds, cut where walls stop short of each other. The lines of the
/// cluster's walls part it into pieces; where walls stand on at least config.cut_share of the edge between two pieces,
/// the edge parts them: walls with free space on both sides or, before what the robot did not enter, planes that rays
/// pass on most of the edge. An alcove and the arm of a bent room have no wall on the edge where they begin. Parts
/// below config.min_part_m2 go to the neighbour with which they share the longest opening. `faces`: all walls, also
/// those that run through the cluster, as the frame of a glass front does. Nothing where it is one room.
[[nodiscard]] std::vector<Cluster> cut_along_walls(const ClusterWalls& cluster_walls, std::span<const FaceLine> faces,
                                                   std::span<const Eigen::Vector2d> visited_M);

}  // namespace plumbline::slam
