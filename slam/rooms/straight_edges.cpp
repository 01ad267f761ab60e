// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/straight_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "slam/rooms/arrangement.h"

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr double least_edge_m = 1.0;

/// Length along an edge in which its cells show: they lie in a chain, so at most a diagonal apart.
constexpr double place_cells = 1.5;

/// Border cells whose neighbour against m lies outside, by their offset along m in cells: places along the edge.
std::map<int, std::set<int>> rows_of(const ClusterWalls& cluster_walls, const Vector2d& m) {
  constexpr double beyond_cells = 1.5;  // the next cell, at any heading
  const GridFrame& frame = cluster_walls.grid.frame;
  const std::vector<std::size_t>& cells = cluster_walls.cluster.cells;
  const Vector2d along(-m.y(), m.x());
  std::map<int, std::set<int>> rows;
  for (const Vector2d& p : cluster_walls.border_M) {
    const auto next = frame.find(p - beyond_cells * frame.cell * m);
    if (next && std::binary_search(cells.begin(), cells.end(), *next)) continue;
    rows[static_cast<int>(std::floor(m.dot(p) / frame.cell))].insert(
        static_cast<int>(std::floor(along.dot(p) / (place_cells * frame.cell))));
  }
  return rows;
}

/// One edge a row and the two behind it, between which an edge at a slant goes to and fro.
std::vector<FaceLine> edges_of(const ClusterWalls& cluster_walls, const Vector2d& m) {
  const double cell = cluster_walls.grid.frame.cell, place_m = place_cells * cell;
  const std::map<int, std::set<int>> rows = rows_of(cluster_walls, m);
  std::vector<FaceLine> edges;
  for (const auto& [row, first] : rows) {
    std::set<int> places = first;
    for (const int next : {row + 1, row + 2})
      if (const auto more = rows.find(next); more != rows.end())
        places.insert(more->second.begin(), more->second.end());
    const double length = place_m * static_cast<double>(places.size());
    if (length < least_edge_m) continue;
    FaceLine edge = cut_line(m, cell * static_cast<double>(row) * m);
    edge.s0 = place_m * static_cast<double>(*places.begin());
    edge.s1 = place_m * static_cast<double>(*places.rbegin() + 1);
    edge.support = length;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace

std::vector<FaceLine> straight_edges(const ClusterWalls& cluster_walls, const Vector2d& axis) {
  const Vector2d across(-axis.y(), axis.x());
  std::vector<FaceLine> edges;
  for (const Vector2d& m : {axis, Vector2d(-axis), across, Vector2d(-across)}) {
    const std::vector<FaceLine> more = edges_of(cluster_walls, m);
    edges.insert(edges.end(), more.begin(), more.end());
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const FaceLine& a, const FaceLine& b) { return a.support > b.support; });
  std::vector<FaceLine> kept;
  for (const FaceLine& edge : edges)
    if (std::none_of(kept.begin(), kept.end(), [&](const FaceLine& other) {
          return parallel(edge, other, cluster_walls.config) && std::abs(edge.e - other.e) < same_line_m;
        }))
      kept.push_back(edge);
  return kept;
}

}  // namespace plumbline::slam
