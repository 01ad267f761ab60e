// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/traffic_editor/traffic_editor_gaps.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/polygon.h"

namespace plumbline::bim {

namespace {

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

Eigen::Vector2d unit(const Segment& s) { return (s.b - s.a).normalized(); }

/// A free end of a wall, with its direction away from the wall.
struct FreeEnd {
  std::size_t wall = 0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d ahead = Eigen::Vector2d::UnitX();
  bool used = false;
};

bool touches_another(const std::vector<Segment>& walls, std::size_t self, const Eigen::Vector2d& p, double within_m) {
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (i != self && segment_distance(walls[i].a, walls[i].b, p) <= within_m) return true;
  return false;
}

std::vector<FreeEnd> free_ends(const std::vector<Segment>& walls, const TrafficEditorConfig& config) {
  std::vector<FreeEnd> ends;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Eigen::Vector2d e = unit(walls[i]);
    if (!touches_another(walls, i, walls[i].a, config.touching_m)) ends.push_back({i, walls[i].a, -e});
    if (!touches_another(walls, i, walls[i].b, config.touching_m)) ends.push_back({i, walls[i].b, e});
  }
  return ends;
}

/// The nearest end that faces `from` and that `from` faces.
FreeEnd* facing(std::vector<FreeEnd>& ends, const FreeEnd& from, const TrafficEditorConfig& config) {
  FreeEnd* best = nullptr;
  double nearest = config.doorway_max_m;
  for (FreeEnd& to : ends) {
    const Eigen::Vector2d between = to.p - from.p;
    const double gap = between.norm();
    if (to.used || to.wall == from.wall || gap > nearest || gap < config.touching_m) continue;
    if (best != nullptr && gap == nearest) continue;
    const Eigen::Vector2d u = between / gap;
    const bool ahead = from.ahead.dot(u) > 0.0 && std::abs(cross(from.ahead, u)) <= config.in_line;
    const bool back = to.ahead.dot(u) < 0.0 && std::abs(cross(to.ahead, u)) <= config.in_line;
    if (!ahead || !back) continue;
    best = &to;
    nearest = gap;
  }
  return best;
}

/// Distance straight ahead to the first wall, m.
std::optional<double> wall_ahead(const std::vector<Segment>& walls, const FreeEnd& from, double reach_m) {
  std::optional<double> nearest;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Eigen::Vector2d along = walls[i].b - walls[i].a;
    const double turn = cross(from.ahead, along);
    if (i == from.wall || std::abs(turn) <= 1e-9 * along.norm()) continue;
    const Eigen::Vector2d to = walls[i].a - from.p;
    const double t = cross(to, along) / turn, k = cross(to, from.ahead) / turn;
    if (k < 0.0 || k > 1.0 || t <= 0.0 || t > reach_m || (nearest && t >= *nearest)) continue;
    nearest = t;
  }
  return nearest;
}

}  // namespace

std::optional<std::pair<double, double>> overlap_in_line(const Segment& wall, const Segment& door,
                                                         const TrafficEditorConfig& config) {
  const Eigen::Vector2d e = unit(wall);
  if (std::abs(cross(e, unit(door))) > config.in_line) return std::nullopt;
  if (std::abs(cross(e, door.a - wall.a)) > config.on_wall_m || std::abs(cross(e, door.b - wall.a)) > config.on_wall_m)
    return std::nullopt;
  const double sa = e.dot(door.a - wall.a), sb = e.dot(door.b - wall.a);
  const double s0 = std::max(0.0, std::min(sa, sb)), s1 = std::min(wall.length(), std::max(sa, sb));
  if (s1 - s0 < config.least_span_m) return std::nullopt;
  return std::pair(s0, s1);
}

bool is_corner(const std::vector<Segment>& walls, std::size_t self, const Eigen::Vector2d& p,
               const TrafficEditorConfig& config) {
  const Eigen::Vector2d e = unit(walls[self]);
  constexpr double joined_m = 1e-3;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (i == self || std::abs(cross(e, unit(walls[i]))) <= config.in_line) continue;
    if ((walls[i].a - p).norm() <= joined_m || (walls[i].b - p).norm() <= joined_m) return true;
  }
  return false;
}

std::vector<Segment> find_doorways(const std::vector<Segment>& walls, const TrafficEditorConfig& config) {
  std::vector<FreeEnd> ends = free_ends(walls, config);
  std::vector<Segment> gaps;
  for (FreeEnd& end : ends) {
    if (end.used) continue;
    FreeEnd* other = facing(ends, end, config);
    if (other == nullptr) continue;
    end.used = other->used = true;
    gaps.push_back({end.p, other->p});
  }
  for (const FreeEnd& end : ends) {
    if (end.used) continue;
    if (const auto t = wall_ahead(walls, end, config.side_gap_max_m)) gaps.push_back({end.p, end.p + *t * end.ahead});
  }
  return gaps;
}

}  // namespace plumbline::bim
