// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

struct Box {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  [[nodiscard]] bool contains(const Eigen::Vector2d& p) const {
    return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1;
  }
};

/// A drawn floor: free space is in some of `free` and in none of `solid`; faces run from a to b with free space to the
/// left. All are turned by the heading and moved into a grid of 30 x 30 m.
struct Scene {
  std::vector<Box> free, solid;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> faces;
  double yaw = 0.0;

  [[nodiscard]] Pose X_MW() const { return Pose::from_xyz_yaw({13.0, 9.0, 0.0}, yaw); }
  [[nodiscard]] Eigen::Vector2d to_M(const Eigen::Vector2d& p_W) const {
    return (X_MW() * Eigen::Vector3d(p_W.x(), p_W.y(), 0.0)).head<2>();
  }
  [[nodiscard]] FreeGrid grid() const {
    FreeGrid grid{{{0.0, 0.0}, 0.1, 300, 300}, {}};
    const Pose X_WM = X_MW().inverse();
    for (std::size_t k = 0; k < grid.frame.size(); ++k) {
      const Eigen::Vector2d p_M = grid.frame.center(k);
      const Eigen::Vector2d p = (X_WM * Eigen::Vector3d(p_M.x(), p_M.y(), 0.0)).head<2>();
      const auto holds = [&](const Box& box) { return box.contains(p); };
      grid.free.push_back(
          std::any_of(free.begin(), free.end(), holds) && std::none_of(solid.begin(), solid.end(), holds) ? 1 : 0);
    }
    return grid;
  }
  [[nodiscard]] std::vector<PlaneNode> walls() const {
    std::vector<PlaneNode> walls;
    for (const auto& [a_W, b_W] : faces) {
      PlaneNode wall;
      wall.id = static_cast<int>(walls.size());
      wall.p0 = to_M(a_W);
      wall.p1 = to_M(b_W);
      const Eigen::Vector2d t = (wall.p1 - wall.p0).normalized(), n(-t.y(), t.x());
      wall.plane_F = Plane{{n.x(), n.y(), 0.0}, -n.dot(wall.p0)};
      wall.z1 = 2.5;
      walls.push_back(wall);
    }
    return walls;
  }
  /// Faces of a box's inside, with a gap where `open` says: side 0 is y = y0, then counter-clockwise.
  void enclose(const Box& b, const std::vector<int>& open = {}) {
    const Eigen::Vector2d corners[] = {{b.x0, b.y0}, {b.x1, b.y0}, {b.x1, b.y1}, {b.x0, b.y1}};
    for (int side = 0; side < 4; ++side)
      if (std::find(open.begin(), open.end(), side) == open.end())
        faces.emplace_back(corners[side], corners[(side + 1) % 4]);
  }
  [[nodiscard]] std::vector<Eigen::Vector2d> at(const std::vector<Eigen::Vector2d>& points_W) const {
    std::vector<Eigen::Vector2d> points_M;
    for (const Eigen::Vector2d& p : points_W) points_M.push_back(to_M(p));
    return points_M;
  }
  [[nodiscard]] std::vector<RoomCandidate> rooms(const std::vector<Eigen::Vector2d>& visited_W) const {
    const FreeGrid drawn = grid();
    return detect_rooms(drawn, clusters(drawn, {}), walls(), at(visited_W), {});
  }
};

inline const double headings[] = {0.0, 0.3, 1.2};

}  // namespace plumbline::slam
