// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/rooms/detect.h"

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
[[nodiscard]] Eigen::Vector2d meet(const FaceLine& a, const FaceLine& b);

struct Scene {
  const FreeGrid& grid;
  const Cluster& cluster;
  const RoomConfig& config;
  std::vector<Eigen::Vector2d> border_M;  ///< centres of the cluster's boundary
  std::vector<FaceLine> walls;            ///< that carry at least min_support_m of the cluster's border
};

[[nodiscard]] Scene make_scene(const FreeGrid& grid, const Cluster& cluster, std::span<const FaceLine> faces,
                               const RoomConfig& config);

/// Length of the scene's border that lies on the line between from and to (along it), on its free side, m.
[[nodiscard]] double border_on(const FaceLine& line, double from, double to, const Scene& scene);

[[nodiscard]] Polygon2 counter_clockwise(Polygon2 polygon);

}  // namespace plumbline::slam
