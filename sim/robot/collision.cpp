// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/collision.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumbline::sim {

namespace {

struct Interval {
  double from = 0.0;
  double to = 0.0;
};

/// Heights a robot on the storey can touch, in W.
Interval touchable(const bim::Building& building, int storey, const CollisionConfig& config) {
  const double floor = building.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  return {floor + config.floor_gap_m, floor + config.reach_m};
}

bool overlap(const Interval& a, const Interval& b) { return a.from < b.to && b.from < a.to; }

/// Rectangle with a height, its x axis along `yaw`.
CollisionBox upright_box(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& half, const Interval& z) {
  CollisionBox box;
  box.X_WB = Pose::from_xyz_yaw({center.x(), center.y(), 0.5 * (z.from + z.to)}, yaw);
  box.half = {half.x(), half.y(), 0.5 * (z.to - z.from)};
  return box;
}

/// A closed leaf fills its opening.
bool passable(const bim::Opening& opening) { return opening.leaf != bim::Leaf::closed; }

/// Positions along the wall where its elevation can change, ascending, with extra cuts every length_max_m.
std::vector<double> wall_cuts(const bim::Wall& wall, const std::vector<const bim::Opening*>& openings,
                              double length_max_m) {
  const double length = wall.length();
  std::vector<double> cuts = {0.0, length};
  for (const bim::Opening* o : openings) {
    cuts.push_back(std::clamp(o->s_m - 0.5 * o->width_m, 0.0, length));
    cuts.push_back(std::clamp(o->s_m + 0.5 * o->width_m, 0.0, length));
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<double> all;
  for (const double cut : cuts) {
    const double last = all.empty() ? cut : all.back();
    const int parts = std::max(1, static_cast<int>(std::ceil((cut - last) / length_max_m)));
    for (int i = 1; i < parts; ++i) all.push_back(last + (cut - last) * i / parts);
    if (all.empty() || cut - last > 1e-6) all.push_back(cut);
  }
  return all;
}

/// Heights of the wall that are solid at s: the wall's own, minus every opening there.
std::vector<Interval> solid_heights(const bim::Wall& wall, const std::vector<const bim::Opening*>& openings, double s) {
  std::vector<Interval> solid = {{wall.z0_m, wall.z1_m}};
  for (const bim::Opening* o : openings) {
    if (std::abs(s - o->s_m) >= 0.5 * o->width_m) continue;
    std::vector<Interval> rest;
    for (const Interval& z : solid) {
      if (o->z0_m > z.from) rest.push_back({z.from, std::min(z.to, o->z0_m)});
      if (o->z1_m < z.to) rest.push_back({std::max(z.from, o->z1_m), z.to});
    }
    solid = std::move(rest);
  }
  return solid;
}

void add_wall(const bim::Building& building, int index, const Interval& reach, const CollisionConfig& config,
              std::vector<CollisionBox>& boxes) {
  const bim::Wall& wall = building.walls[static_cast<std::size_t>(index)];
  std::vector<const bim::Opening*> openings;
  for (const bim::Opening& o : building.openings)
    if (o.wall == index && passable(o)) openings.push_back(&o);

  const Eigen::Vector2d e = wall.direction();
  const double across = wall.offset_m + 0.5 * wall.thickness_m;
  const std::vector<double> cuts = wall_cuts(wall, openings, config.length_max_m);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double s = 0.5 * (cuts[i] + cuts[i + 1]);
    const Eigen::Vector2d center = wall.a + s * e + across * wall.left();
    for (const Interval& z : solid_heights(wall, openings, s))
      if (overlap(z, reach))
        boxes.push_back(
            upright_box(center, std::atan2(e.y(), e.x()), {0.5 * (cuts[i + 1] - cuts[i]), 0.5 * wall.thickness_m}, z));
  }
}

/// The smallest of the bounding rectangles along `directions` (ties: the first).
CollisionBox bounding_box(const std::vector<Eigen::Vector2d>& points, const std::vector<double>& directions,
                          const Interval& z) {
  CollisionBox best;
  double best_area = -1.0;
  for (const double yaw : directions) {
    const Eigen::Vector2d ex(std::cos(yaw), std::sin(yaw));
    const Eigen::Vector2d ey(-ex.y(), ex.x());
    Eigen::Vector2d low(ex.dot(points[0]), ey.dot(points[0]));
    Eigen::Vector2d high = low;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d local(ex.dot(p), ey.dot(p));
      low = low.cwiseMin(local);
      high = high.cwiseMax(local);
    }
    const double area = (high - low).prod();
    if (best_area >= 0.0 && area >= best_area - 1e-9) continue;
    best_area = area;
    const Eigen::Vector2d mid = 0.5 * (low + high);
    best = upright_box(mid.x() * ex + mid.y() * ey, yaw, 0.5 * (high - low), z);
  }
  return best;
}

void add_outline(const std::vector<Eigen::Vector2d>& points, const Interval& z, std::vector<CollisionBox>& boxes) {
  constexpr int direction_count = 36;  // every 2.5 degrees of a quarter turn
  if (points.empty()) return;
  std::vector<double> directions;
  for (int i = 0; i < direction_count; ++i) directions.push_back(i * 0.5 * std::numbers::pi / direction_count);
  boxes.push_back(bounding_box(points, directions, z));
}

void add_obstacle(const bim::Obstacle& obstacle, const Interval& reach, std::vector<CollisionBox>& boxes) {
  std::vector<Eigen::Vector2d> points;
  Interval z{1e9, -1e9};
  for (const Eigen::Vector3d& v : obstacle.body.vertices) {
    points.emplace_back(v.head<2>());
    z = {std::min(z.from, v.z()), std::max(z.to, v.z())};
  }
  if (overlap(z, reach)) add_outline(points, z, boxes);
}

}  // namespace

double distance(const CollisionBox& box, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_B = box.X_WB.inverse() * p_W;
  return (p_B.cwiseAbs() - box.half).cwiseMax(0.0).norm();
}

std::vector<CollisionBox> collision_boxes(const bim::Building& as_built, int storey, const CollisionConfig& config) {
  const Interval reach = touchable(as_built, storey, config);
  std::vector<CollisionBox> boxes;
  for (std::size_t i = 0; i < as_built.walls.size(); ++i) add_wall(as_built, static_cast<int>(i), reach, config, boxes);
  for (const bim::Column& column : as_built.columns)
    if (overlap({column.z0_m, column.z1_m}, reach)) add_outline(column.footprint, {column.z0_m, column.z1_m}, boxes);
  for (const bim::Obstacle& obstacle : as_built.obstacles) add_obstacle(obstacle, reach, boxes);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].id = static_cast<int>(i);
  return boxes;
}

}  // namespace plumbline::sim
