// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "slam/rooms/room_detector.h"

/// One cluster of free space among the wall faces round it, in plan: what all kinds of rooms are found in.
namespace plumbline::slam {

/// A wall face in plan: m.p + e = 0, m into free space, and the stretch [s0, s1] along `along`.
struct FaceLine {
  int id = -1;  ///< of the PlaneNode; -1: no wall, a cut through free space
  Eigen::Vector2d m = Eigen::Vector2d::UnitX(), along = Eigen::Vector2d::UnitY();
  double e = 0.0, s0 = 0.0, s1 = 0.0;
  double support = 0.0;  ///< m of the cluster's border on it

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const { return m.dot(p) + e; }
};

[[nodiscard]] FaceLine face_line(const PlaneNode& wall);
/// A line without a wall: the half plane m.p >= m.at is inside.
[[nodiscard]] FaceLine cut_line(const Eigen::Vector2d& m, const Eigen::Vector2d& at);
/// Where two lines cross; they must not be parallel.
[[nodiscard]] Eigen::Vector2d intersection(const FaceLine& a, const FaceLine& b);

struct ClusterWalls {
  const FreeGrid& grid;
  const Cluster& cluster;
  const RoomConfig& config;
  std::vector<CellRun> runs;              ///< of the cluster's cells
  std::vector<Eigen::Vector2d> border_M;  ///< centres of the cluster's boundary
  std::vector<FaceLine> walls;            ///< that carry at least min_support_m of the cluster's border
};

[[nodiscard]] ClusterWalls make_cluster_walls(const FreeGrid& grid, const Cluster& cluster,
                                              std::span<const FaceLine> faces, const RoomConfig& config);

/// Indices in a cluster, [from, to).
struct Stretch {
  std::size_t from = 0, to = 0;
  [[nodiscard]] std::size_t cells() const { return to > from ? to - from : 0; }
  [[nodiscard]] Stretch within(const Stretch& other) const {
    return {std::max(from, other.from), std::min(to, other.to)};
  }
};

/// Those cells of a run whose centres `holds` for, by their distance to the line: a distance only grows or only falls
/// along a row, in floating point too, so that a threshold cuts the run in two.
template <class Holds>
[[nodiscard]] Stretch partition_run(const GridFrame& frame, const CellRun& run, const FaceLine& line,
                                    const Holds& holds) {
  const auto at = [&](std::size_t k) {
    return holds(line.distance(frame.center(run.i + static_cast<int>(k - run.from), run.j)));
  };
  const bool first = at(run.from), last = at(run.to - 1);
  if (first == last) return first ? Stretch{run.from, run.to} : Stretch{run.from, run.from};
  std::size_t low = run.from, high = run.to - 1;  // at(low) is as the first cell, at(high) as the last
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (at(middle) == first ? low : high) = middle;
  }
  return first ? Stretch{run.from, high} : Stretch{high, run.to};
}

/// Length of the cluster's border that lies on the line between from and to (along it), on its free side, m.
[[nodiscard]] double border_on(const FaceLine& line, double from, double to, const ClusterWalls& cluster_walls);

[[nodiscard]] Polygon2 counter_clockwise(Polygon2 polygon);

}  // namespace plumbline::slam
