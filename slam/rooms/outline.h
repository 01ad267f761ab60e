// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// One side of a room's outline, from its own corner to the next side's.
struct OutlineSide {
  int wall = -1;  ///< PlaneNode id, or -1 where no wall was seen: an opening
  Eigen::Vector2d from_M = Eigen::Vector2d::Zero();
};

/// The closed chain of faces and openings round a cluster.
struct Outline {
  std::vector<OutlineSide> sides;  ///< counter-clockwise, no two neighbours on one line
  double fill = 0.0;               ///< free share of what it encloses
  double wall_share = 0.0;         ///< share of its length that lies on walls that were seen
  double edge_share = 0.0;         ///< share of its length that lies on walls or on straight edges of free space
  double inside = 0.0;             ///< share of the cluster's cells that it encloses
  bool ring = false;               ///< it encloses something that is no part of the room and larger than a column
};

[[nodiscard]] Polygon2 polygon_of(const Outline& outline);

/// Gives a room the planes of the outline's walls in order, the corners where two of them meet, and those corners' mean
/// as its centre. Where a wall goes on in itself, or in one that is nearly parallel, there is no corner: nothing would
/// fix where along them it lies. `walls`: at least all that the outline names.
void set_polygon_planes(const Outline& outline, std::span<const FaceLine> walls, RoomCandidate& room);

/// The lines of the walls, and four cuts where free space ends, part the plane into convex pieces; those mostly free
/// make the room, their border is its outline. Nothing where no piece is mostly free, or where walls are too many.
/// `edges`: straight edges of free space, to take as lines as well.
[[nodiscard]] std::optional<Outline> outline_of(const ClusterWalls& cluster_walls,
                                                std::span<const FaceLine> edges = {});

}  // namespace plumbline::slam
