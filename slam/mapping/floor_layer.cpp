// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/floor_layer.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace plumbline::slam {

namespace {

struct WidePair {
  Eigen::Vector2d across;
  double middle = 0.0;  ///< along `across`
  double width = 0.0;
};

/// The widest pair of walls that face each other, perpendicular to `axis` where one is given; ties: lower ids.
std::optional<WidePair> widest_pair(std::span<const PlaneNode> walls, const std::optional<Eigen::Vector2d>& axis,
                                    const FloorLayerConfig& config) {
  std::optional<WidePair> best;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const Eigen::Vector2d a = walls[i].plane_F.n.head<2>().normalized();
      const Eigen::Vector2d b = walls[j].plane_F.n.head<2>().normalized();
      if (a.dot(b) > -config.opposed_cos) continue;
      const Eigen::Vector2d across = (a - b).normalized();
      if (axis && std::abs(axis->dot(across)) > std::sqrt(1.0 - config.opposed_cos * config.opposed_cos)) continue;
      const double from = across.dot(0.5 * (walls[i].p0 + walls[i].p1));
      const double to = across.dot(0.5 * (walls[j].p0 + walls[j].p1));
      // Facing each other: j lies on the side to which i's normal points.
      if (to - from < config.min_width_m || (best && to - from <= best->width)) continue;
      best = WidePair{across, 0.5 * (from + to), to - from};
    }
  return best;
}

bool has_released_floor(const Graph& graph, int storey) {
  return std::any_of(graph.planes.begin(), graph.planes.end(),
                     [&](const PlaneVertex& plane) { return plane.released && plane.storey == storey; });
}

/// The storey's floor vertex, made on first use.
int floor_vertex_of(Graph& graph, int storey, const Eigen::Vector2d& center_M) {
  for (std::size_t id = 0; id < graph.floors.size(); ++id)
    if (graph.floors[id].storey == storey) return static_cast<int>(id);
  graph.floors.push_back({.center_M = center_M, .storey = storey});
  return static_cast<int>(graph.floors.size()) - 1;
}

}  // namespace

double height_at(const Plane& plane, const Eigen::Vector2d& p) {
  return -(plane.d + plane.n.head<2>().dot(p)) / plane.n.z();
}

int floor_plane_of(const Graph& graph, int storey) {
  for (std::size_t id = 0; id < graph.planes.size(); ++id)
    if (graph.planes[id].kind == PlaneKind::floor && graph.planes[id].storey == storey &&
        graph.planes[id].merged_into < 0 && !graph.planes[id].released)
      return static_cast<int>(id);
  return -1;
}

int storey_of(const Graph& graph, const Pose& X_MR, std::span<const PlaneObservation> seen,
              const FloorLayerConfig& config) {
  const int former = graph.keyframes.empty() ? 0 : graph.keyframes.back().storey;
  const auto floor = std::find_if(seen.begin(), seen.end(),
                                  [](const PlaneObservation& o) { return !o.vertical && o.plane_R.n.z() > 0.0; });
  if (floor == seen.end()) return former;
  // On ground that slopes no height is a storey's.
  if (has_released_floor(graph, former) && floor_plane_of(graph, former) < 0) return former;
  const Eigen::Vector2d here = X_MR.t.head<2>();
  const double height = height_at(X_MR * floor->plane_R, here);
  if (std::abs(X_MR.t.z() - height - config.robot_height_m) > config.underfoot_m) return former;
  int last = -1;
  for (const PlaneVertex& plane : graph.planes) last = std::max(last, plane.storey);
  // Stairs and their landings belong to the storey below, or, where none is known, to the one above.
  int below = -1, above = -1;
  double over = config.storey_step_m, under = config.storey_step_m;
  bool any_floor = false;
  for (int storey = 0; storey <= last; ++storey) {
    const int id = floor_plane_of(graph, storey);
    if (id < 0) continue;
    any_floor = true;
    const double d = height - height_at(graph.planes[static_cast<std::size_t>(id)].plane_M, here);
    if (d > -config.same_floor_m && d < over) {
      over = d;
      below = storey;
    } else if (d <= 0.0 && -d < under) {
      under = -d;
      above = storey;
    }
  }
  if (!any_floor) return former;
  if (below >= 0) return below;
  return above >= 0 ? above : last + 1;
}

void drop_tilted_planes(std::vector<PlaneObservation>& seen, const Pose& X_MR, const FloorLayerConfig& config) {
  const double least = std::cos(config.level_rad);
  std::erase_if(seen,
                [&](const PlaneObservation& o) { return !o.vertical && std::abs((X_MR.q * o.plane_R.n).z()) < least; });
}

void FloorLayer::update(Graph& graph, int storey, std::span<const PlaneNode> walls) {
  const std::optional<WidePair> x = widest_pair(walls, std::nullopt, config_);
  if (!x) return;
  const std::optional<WidePair> y = widest_pair(walls, x->across, config_);
  if (!y) return;
  Eigen::Matrix2d axes;
  axes << x->across.transpose(), y->across.transpose();
  const Eigen::Vector2d center = axes.inverse() * Eigen::Vector2d(x->middle, y->middle);
  const int id = floor_vertex_of(graph, storey, center);
  FloorVertex& floor = graph.floors[static_cast<std::size_t>(id)];
  floor.plane = floor_plane_of(graph, storey);
  const auto on_this_floor = [&](int room) { return graph.rooms[static_cast<std::size_t>(room)].storey == storey; };
  if ((center - floor.center_M).norm() > config_.refresh_m) {
    floor.center_M = center;
    std::erase_if(room_offsets_, [&](const RoomOffset& room_offset) { return on_this_floor(room_offset.room); });
  }
  std::erase_if(graph.floor_factors, [&](const FloorFactor& f) { return f.floor == id; });
  const double weight = 1.0 / (config_.room_sigma_m * config_.room_sigma_m);
  for (std::size_t room = 0; room < graph.rooms.size(); ++room) {
    if (!graph.rooms[room].found || !on_this_floor(static_cast<int>(room))) continue;
    auto room_offset = std::find_if(room_offsets_.begin(), room_offsets_.end(),
                                    [&](const RoomOffset& p) { return p.room == static_cast<int>(room); });
    if (room_offset == room_offsets_.end())
      room_offset = room_offsets_.insert(room_offsets_.end(),
                                         {static_cast<int>(room), floor.center_M - graph.rooms[room].center_M});
    graph.floor_factors.push_back(
        {id, static_cast<int>(room), room_offset->offset_M, weight * Eigen::Matrix2d::Identity()});
  }
}

}  // namespace plumbline::slam
