// SPDX-License-Identifier: Apache-2.0
#include "bim/model/door_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bim/model/hull.h"

namespace plumbline::bim {
namespace {

/// The plan of a door: from a to b, with a side on the left (0) and on the right (1).
struct Doorway {
  Eigen::Vector2d a, b;
  double depth_m = 0.0, foot_m = 0.0;
  int rooms[2] = {-1, -1};

  [[nodiscard]] Eigen::Vector2d along() const { return (b - a).normalized(); }
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (a + b); }
};

/// A stretch of a rim, of which the room lies left.
struct RimStretch {
  Eigen::Vector2d a, b;
};

/// False for a body that is no plate, such as one with a leaf drawn open.
bool is_flat(const ThinRectangle& rectangle) {
  constexpr double least_m = 0.4;
  const double length_m = (rectangle.b - rectangle.a).norm();
  return length_m >= least_m && rectangle.width_m <= 0.5 * length_m;
}

/// The nearer of two places in front of the door's side that lies in a room.
int room_before(const Building& building, const Doorway& door, int side, const AdjacencyConfig& config) {
  const Eigen::Vector2d e = door.along(), left(-e.y(), e.x());
  for (const double far : {config.step_m, 2.0 * config.step_m}) {
    const double across = (side == 0 ? 1.0 : -1.0) * (0.5 * door.depth_m + far);
    const int room = room_at(building, door.middle() + across * left, door.foot_m, config);
    if (room >= 0) return room;
  }
  return -1;
}

/// Where the door lies along the nearest edge of the room's rims that runs along it; across the door itself without
/// one.
RimStretch stretch_at(const Room& room, const Doorway& door, int side, const AdjacencyConfig& config) {
  constexpr double parallel = 0.1;
  const Eigen::Vector2d e = side == 0 ? door.along() : Eigen::Vector2d(-door.along());
  RimStretch best{side == 0 ? door.a : door.b, side == 0 ? door.b : door.a};
  const RimStretch whole = best;
  double nearest = 0.5 * door.depth_m + 2.0 * config.step_m;
  for (const Polygon2* rim : room.rims())
    for (std::size_t i = 0; i < rim->size(); ++i) {
      const Eigen::Vector2d &p = (*rim)[i], &q = (*rim)[(i + 1) % rim->size()];
      const Eigen::Vector2d u = (q - p).normalized(), left(-u.y(), u.x());
      const double length = (q - p).norm(), away = std::abs(left.dot(door.middle() - p));
      if (u.dot(e) < 0.0 || std::abs(left.dot(e)) > parallel || away >= nearest) continue;
      const double from = std::clamp(u.dot(whole.a - p), 0.0, length), to = std::clamp(u.dot(whole.b - p), 0.0, length);
      if (to - from <= config.overlap_m) continue;
      nearest = away;
      best = {p + from * u, p + to * u};
    }
  return best;
}

/// What the door's stretch leaves of the edges on its line, and the stretch with the door's name behind it.
void cut_in(std::vector<VirtualEdge>& edges, const RimStretch& stretch, int beyond, const std::string& id,
            const AdjacencyConfig& config) {
  std::vector<VirtualEdge> kept;
  const Eigen::Vector2d u = (stretch.b - stretch.a).normalized(), left(-u.y(), u.x());
  for (const VirtualEdge& edge : edges) {
    const double from = u.dot(edge.a - stretch.a), to = u.dot(edge.b - stretch.a),
                 length = (stretch.b - stretch.a).norm();
    const bool on_line = std::abs(left.dot(edge.a - stretch.a)) < config.gap_m &&
                         std::abs(left.dot(edge.b - stretch.a)) < config.gap_m && from < to;
    if (!on_line || !edge.door.empty() || to <= 0.0 || from >= length) {
      kept.push_back(edge);
      continue;
    }
    if (-from > config.overlap_m) kept.push_back({edge.a, stretch.a, edge.room});
    if (to - length > config.overlap_m) kept.push_back({stretch.b, edge.b, edge.room});
  }
  kept.push_back({stretch.a, stretch.b, beyond, id});
  edges = std::move(kept);
}

}  // namespace

void add_door_edges(Building& building, const std::vector<FreeDoor>& doors, const AdjacencyConfig& config) {
  for (const FreeDoor& free : doors) {
    Polygon2 points;
    double foot_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : free.body.vertices) {
      points.emplace_back(p.head<2>());
      foot_m = std::min(foot_m, p.z());
    }
    const ThinRectangle rectangle = thinnest_rectangle(convex_hull(points));
    if (!is_flat(rectangle)) continue;
    Doorway door{rectangle.a, rectangle.b, rectangle.width_m, foot_m};
    for (const int side : {0, 1}) door.rooms[side] = room_before(building, door, side, config);
    if (door.rooms[0] == door.rooms[1]) continue;
    for (const int side : {0, 1}) {
      if (door.rooms[side] < 0) continue;
      Room& room = building.rooms[static_cast<std::size_t>(door.rooms[side])];
      cut_in(room.virtual_edges, stretch_at(room, door, side, config), door.rooms[1 - side], free.id, config);
    }
  }
}

}  // namespace plumbline::bim
