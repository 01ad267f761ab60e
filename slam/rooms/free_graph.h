// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "slam/rooms/free_space.h"

namespace plumbline::slam {

/// Centre of a ball of free space.
struct FreeVertex {
  std::size_t cell = 0;
  double distance_m = 0.0;  ///< to the nearest obstacle: the ball's radius
};

struct FreeEdge {
  int a = 0, b = 0;
  double distance_m = 0.0;  ///< to the nearest obstacle at the best point where one steps from a's cells to b's
};

/// Sparse graph of free space [bavle2023, section IV-C], from the distance field alone.
struct FreeGraph {
  std::vector<FreeVertex> vertices;  ///< by falling distance, ties: lower cell
  std::vector<FreeEdge> edges;       ///< a < b, ascending
  std::vector<int> owner;            ///< of every grid cell its vertex, -1 where not free
};

/// Free cells by falling clearance, ties by index. clearance_m: of clearance().
[[nodiscard]] std::vector<std::size_t> by_decreasing_clearance(const GridFrame& frame,
                                                               const std::vector<float>& clearance_m);

/// Cells by falling distance; one without an owned neighbour becomes a vertex, and so does one at least spacing_m from
/// obstacles that no neighbour's vertex covers: neither by its ball nor by one of spacing_m. distance_m: clearance() of
/// the grid.
[[nodiscard]] FreeGraph free_graph(const FreeGrid& grid, const std::vector<float>& distance_m, double spacing_m);

/// What Algorithm 1 removes before it searches for components. near: vertices close to obstacles, which cuts at doors
/// (short paper; the papers' code); far: those far from them, as the long paper prints it, which leaves the doors.
enum class Removal { near, far };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Removal) { return {"near", "far"}; }

/// [bavle2023, Alg. 1]: cluster of every vertex: components of what the threshold leaves, then every removed vertex
/// goes to the cluster of its first neighbour that has one (repeated until nothing changes). -1: in none. An edge is
/// removed like a vertex, so that two balls that touch in a doorway do not join the rooms.
[[nodiscard]] std::vector<int> cluster_vertices(const FreeGraph& graph, double threshold_m, Removal removal);

}  // namespace plumbline::slam
