// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/cluster_walls.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace plumbline::slam {

using Eigen::Vector2d;

FaceLine face_line(const PlaneNode& wall) {
  FaceLine line;
  line.id = wall.id;
  const Vector2d xy = wall.plane_F.n.head<2>();
  line.m = xy / xy.norm();
  line.along = Vector2d(-line.m.y(), line.m.x());
  // Through the middle of what was seen: a tilted plane's trace at z = 0 may lie elsewhere.
  line.e = -line.m.dot(0.5 * (wall.p0 + wall.p1));
  line.s0 = std::min(line.along.dot(wall.p0), line.along.dot(wall.p1));
  line.s1 = std::max(line.along.dot(wall.p0), line.along.dot(wall.p1));
  return line;
}

FaceLine cut_line(const Vector2d& m, const Vector2d& at) {
  FaceLine line;
  line.m = m;
  line.along = Vector2d(-m.y(), m.x());
  line.e = -m.dot(at);
  return line;
}

Vector2d intersection(const FaceLine& a, const FaceLine& b) {
  Eigen::Matrix2d A;
  A << a.m.transpose(), b.m.transpose();
  return -(A.inverse() * Vector2d(a.e, b.e));
}

ClusterWalls make_cluster_walls(const FreeGrid& grid, const Cluster& cluster, std::span<const FaceLine> faces,
                                const RoomConfig& config) {
  ClusterWalls cluster_walls{grid, cluster, config, runs_of(grid.frame, cluster.cells), {}, {}};
  for (const std::size_t k : cluster.boundary) cluster_walls.border_M.push_back(grid.frame.center(k));
  // A cell of the border that lies on a face is within reach of its stretch.
  const Vector2d reach = Vector2d::Constant(std::max(config.reach_m, config.slack_m));
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : cluster_walls.border_M) box.extend(p);
  if (box.isEmpty()) return cluster_walls;
  box = {box.min() - reach, box.max() + reach};
  for (const FaceLine& face : faces) {
    Eigen::AlignedBox2d stretch(Vector2d(face.s0 * face.along - face.e * face.m));
    stretch.extend(face.s1 * face.along - face.e * face.m);
    if (!box.intersects(stretch)) continue;
    const double support = border_on(face, face.s0, face.s1, cluster_walls);
    if (support < config.min_support_m) continue;
    cluster_walls.walls.push_back(face);
    cluster_walls.walls.back().support = support;
  }
  return cluster_walls;
}

double border_on(const FaceLine& line, double from, double to, const ClusterWalls& cluster_walls) {
  if (to <= from) return 0.0;
  const double cell = cluster_walls.grid.frame.cell;
  std::vector<bool> covered(static_cast<std::size_t>((to - from) / cell) + 1, false);
  for (const Vector2d& p : cluster_walls.border_M) {
    const double distance = line.distance(p);
    if (distance < -cluster_walls.config.slack_m || distance > cluster_walls.config.reach_m) continue;
    const double s = line.along.dot(p) - from;
    if (s < 0.0 || s > to - from) continue;
    covered[static_cast<std::size_t>(s / cell)] = true;
  }
  return cell * static_cast<double>(std::count(covered.begin(), covered.end(), true));
}

Polygon2 counter_clockwise(Polygon2 polygon) {
  if (signed_area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

}  // namespace plumbline::slam
