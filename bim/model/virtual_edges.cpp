// SPDX-License-Identifier: Apache-2.0
#include "bim/model/virtual_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "bim/geometry/interval.h"
#include "bim/model/boxes.h"
#include "bim/model/hull.h"
#include "bim/model/wall_face.h"
#include "bim/model/wall_section.h"

namespace plumbline::bim {
namespace {

constexpr double passage_m = 1.0;  // where a wall is open, the room beyond begins up to this far away
constexpr double front_m = 0.15;   // a room ends up to this far before panels of a curtain wall, whose posts are deep

/// Stretch of an edge, m from its start.
struct Stretch {
  double from = 0.0, to = 0.0;
};

struct Edge {
  Eigen::Vector2d a, b;

  [[nodiscard]] double length() const { return (b - a).norm(); }
  [[nodiscard]] Eigen::Vector2d along() const { return (b - a).normalized(); }
  [[nodiscard]] Eigen::Vector2d at(double s) const { return a + s * along(); }
};

/// Something that stands on the plan, between two heights.
struct Blocker {
  Polygon2 hull;  ///< convex, counter-clockwise
  double z0_m, z1_m;
  double margin_m;  ///< an edge this close runs along it
};

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

Polygon2 on_plan(const Solid& solid) {
  Polygon2 points;
  for (const Eigen::Vector3d& p : solid.vertices) points.emplace_back(p.head<2>());
  return points;
}

Blocker blocker_of(const Solid& solid, double margin_m) {
  Blocker blocker{convex_hull(on_plan(solid)), 0.0, 0.0, margin_m};
  if (solid.vertices.empty()) return blocker;
  const auto [low, high] = std::minmax_element(solid.vertices.begin(), solid.vertices.end(),
                                               [](const auto& p, const auto& q) { return p.z() < q.z(); });
  blocker.z0_m = low->z();
  blocker.z1_m = high->z();
  return blocker;
}

/// A wall, or the surface of one that is bent or open at walking height, whatever is above its passages.
void add_wall_blockers(const Building& building, int index, const AdjacencyConfig& config,
                       std::vector<Blocker>& blockers) {
  constexpr double face_m = 0.1;
  const Wall& wall = building.walls[static_cast<std::size_t>(index)];
  const std::vector<Opening> openings = openings_of(building, index);
  const auto add = [&](const Interval& z) {
    if (z.length() <= 0.0) return;
    if (is_straight(wall, openings, z)) {
      blockers.push_back({convex_hull(footprint(wall)), z.low, z.high, config.gap_m});
      return;
    }
    for (const Wall& face : surface_walls(wall, 0.5 * (z.low + z.high), face_m))
      blockers.push_back({convex_hull(footprint(face)), z.low, z.high, config.gap_m});
  };
  const Interval whole{wall.z0_m, wall.z1_m}, low{wall.z0_m, std::min(wall.z1_m, wall.z0_m + config.walking_m)};
  if (is_straight(wall, openings, whole) && !is_straight(wall, openings, low)) {
    add(low);
    add({low.high, wall.z1_m});
  } else {
    add(whole);
  }
}

std::vector<Blocker> blockers_of(const Building& building, const AdjacencyConfig& config) {
  constexpr std::array<std::string_view, 6> closing{"curtain_panel", "curtain_wall", "mullion",
                                                    "part",          "plate",        "window"};
  std::vector<Blocker> blockers;
  for (int i = 0; i < static_cast<int>(building.walls.size()); ++i) add_wall_blockers(building, i, config, blockers);
  for (const Column& column : building.columns)
    blockers.push_back({convex_hull(column.footprint), column.z0_m, column.z1_m, config.gap_m});
  for (const Obstacle& obstacle : building.obstacles)
    if (std::find(closing.begin(), closing.end(), obstacle.kind) != closing.end())
      blockers.push_back(blocker_of(obstacle.body, obstacle.kind == "window" ? config.gap_m : front_m));
  return blockers;
}

/// Stretch of the edge within `margin` of a convex hull's inside.
std::optional<Stretch> inside(const Edge& edge, const Polygon2& hull, double margin) {
  Stretch stretch{0.0, edge.length()};
  const Eigen::Vector2d u = edge.along();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d side = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    // Inside is left of every side: cross(side, p - hull[i]) >= -margin.
    const double at_start = cross(side, edge.a - hull[i]) + margin, slope = cross(side, u);
    constexpr double level = 1e-12;
    if (std::abs(slope) < level) {
      if (at_start < 0.0) return std::nullopt;
      continue;
    }
    if (slope > 0.0) {
      stretch.from = std::max(stretch.from, -at_start / slope);
    } else {
      stretch.to = std::min(stretch.to, -at_start / slope);
    }
  }
  return hull.size() >= 3 && stretch.from < stretch.to ? std::optional(stretch) : std::nullopt;
}

/// What is left of stretches once another is taken away.
std::vector<Stretch> without(const std::vector<Stretch>& stretches, const Stretch& taken) {
  std::vector<Stretch> rest;
  for (const Stretch& s : stretches) {
    if (taken.to <= s.from || taken.from >= s.to) {
      rest.push_back(s);
      continue;
    }
    if (taken.from > s.from) rest.push_back({s.from, taken.from});
    if (taken.to < s.to) rest.push_back({taken.to, s.to});
  }
  return rest;
}

/// Height over which something stands before the walking height of a room, m.
double common_height(const Room& room, double low_m, double high_m, const AdjacencyConfig& config) {
  return std::min({room.z1_m, room.z0_m + config.walking_m, high_m}) - std::max(room.z0_m, low_m);
}

/// What may bound rooms.
struct Surroundings {
  std::vector<Blocker> blockers;
  BoxIndex blocker_boxes, room_boxes;
};

Surroundings surroundings_of(const Building& building, const AdjacencyConfig& config) {
  Surroundings around{blockers_of(building, config), {}, boxes_of(building.rooms)};
  for (const Blocker& blocker : around.blockers) around.blocker_boxes.add(blocker.hull);
  return around;
}

/// Finds the virtual edges of one room.
class EdgeFinder {
 public:
  EdgeFinder(const Building& building, const Surroundings& around, int room, const AdjacencyConfig& config)
      : building_(building),
        blockers_(around.blockers),
        room_boxes_(around.room_boxes),
        index_(room),
        room_(building.rooms[static_cast<std::size_t>(room)]),
        near_blockers_(around.blocker_boxes.near(room_.polygon, passage_m)),
        near_rooms_(around.room_boxes.near(room_.polygon, config.virtual_gap_m)),
        config_(config) {}

  [[nodiscard]] std::vector<VirtualEdge> find() const {
    std::vector<VirtualEdge> edges;
    for (const Polygon2* rim : room_.rims())
      for (std::size_t i = 0; i < rim->size(); ++i) {
        const Edge edge{(*rim)[i], (*rim)[(i + 1) % rim->size()]};
        for (const Stretch& stretch : open_stretches(edge)) add(edge, stretch, edges);
      }
    return edges;
  }

 private:
  [[nodiscard]] std::vector<Stretch> open_stretches(const Edge& edge) const {
    std::vector<Stretch> open{{0.0, edge.length()}};
    for (const int index : near_blockers_) {
      const Blocker& blocker = blockers_[static_cast<std::size_t>(index)];
      if (common_height(room_, blocker.z0_m, blocker.z1_m, config_) <= config_.z_overlap_m) continue;
      if (const auto covered = inside(edge, blocker.hull, blocker.margin_m)) open = without(open, *covered);
    }
    return open;
  }

  /// A stretch is divided among the rooms whose outlines run along it; what is left belongs to whoever lies beyond.
  void add(const Edge& edge, const Stretch& stretch, std::vector<VirtualEdge>& edges) const {
    std::vector<Stretch> rest{stretch};
    for (const int i : near_rooms_) {
      const Room& other = building_.rooms[static_cast<std::size_t>(i)];
      const bool meet = i != index_ && common_height(room_, other.z0_m, other.z1_m, config_) > config_.z_overlap_m;
      if (!meet) continue;
      for (const Polygon2* rim : other.rims())
        for (std::size_t k = 0; k < rim->size(); ++k) {
          const auto shared = along(edge, {(*rim)[k], (*rim)[(k + 1) % rim->size()]});
          if (!shared) continue;
          for (const Stretch& part : rest)
            emit(edge, {std::max(part.from, shared->from), std::min(part.to, shared->to)}, i, edges);
          rest = without(rest, *shared);
        }
    }
    for (const Stretch& part : rest) emit(edge, part, beyond(edge, part), edges);
  }

  /// Stretch of an edge along which another runs the other way.
  [[nodiscard]] std::optional<Stretch> along(const Edge& edge, const Edge& other) const {
    const Eigen::Vector2d u = edge.along();
    if (other.length() == 0.0 || u.dot(other.along()) >= 0.0 || std::abs(cross(u, other.along())) > config_.tilt)
      return std::nullopt;
    const double gap_m = config_.virtual_gap_m;
    if (std::abs(cross(u, other.a - edge.a)) > gap_m || std::abs(cross(u, other.b - edge.a)) > gap_m)
      return std::nullopt;
    const Stretch stretch{std::max(0.0, u.dot(other.b - edge.a)), std::min(edge.length(), u.dot(other.a - edge.a))};
    return stretch.from < stretch.to ? std::optional(stretch) : std::nullopt;
  }

  /// The room in front of the middle of a stretch; through a passage in a thick wall as far as nothing stands there.
  [[nodiscard]] int beyond(const Edge& edge, const Stretch& stretch) const {
    constexpr double step_m = 0.05;
    const Eigen::Vector2d u = edge.along(), middle = edge.at((stretch.from + stretch.to) / 2.0), out(u.y(), -u.x());
    const Edge way{middle, middle + passage_m * out};
    const std::vector<int> rooms = room_boxes_.near({way.a, way.b}, 0.0);
    const double free_m = free_length(way);
    for (double far = std::min(config_.step_m, 0.5 * free_m); far < free_m; far += step_m) {
      const int room = room_among(building_, rooms, middle + far * out, room_.z0_m, config_);
      if (room >= 0) return room == index_ ? -1 : room;
    }
    return -1;
  }

  /// Length of a way up to the first thing that stands in it, however thin, m.
  [[nodiscard]] double free_length(const Edge& way) const {
    double free_m = way.length();
    for (const int index : near_blockers_) {
      const Blocker& blocker = blockers_[static_cast<std::size_t>(index)];
      if (common_height(room_, blocker.z0_m, blocker.z1_m, config_) <= config_.z_overlap_m) continue;
      if (const auto covered = inside(way, blocker.hull, 0.0)) free_m = std::min(free_m, covered->from);
    }
    return free_m;
  }

  void emit(const Edge& edge, const Stretch& stretch, int room, std::vector<VirtualEdge>& edges) const {
    if (stretch.to - stretch.from > config_.overlap_m)
      edges.push_back({edge.at(stretch.from), edge.at(stretch.to), room});
  }

  const Building& building_;
  const std::vector<Blocker>& blockers_;
  const BoxIndex& room_boxes_;
  int index_;
  const Room& room_;
  std::vector<int> near_blockers_, near_rooms_;
  AdjacencyConfig config_;
};

/// Smallest room of a storey that holds a point, before any other that does.
int room_on(const Building& building, int storey, const Eigen::Vector2d& p, double floor_m,
            const AdjacencyConfig& config) {
  int smallest = -1;
  double least_m2 = 0.0;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const Room& room = building.rooms[i];
    const double z = floor_m + config.above_sill_m;
    const bool at_height = z >= room.z0_m - config.below_floor_m && z <= room.z1_m;
    if (room.storey != storey || !at_height || !room.contains(p)) continue;
    const double area_m2 = room.area_m2();
    if (smallest >= 0 && area_m2 >= least_m2) continue;
    smallest = static_cast<int>(i);
    least_m2 = area_m2;
  }
  return smallest >= 0 ? smallest : room_at(building, p, floor_m, config);
}

/// The first of the points that lies in a room.
int room_at_one_of(const Building& building, int storey, const std::array<Eigen::Vector2d, 2>& points, double floor_m,
                   const AdjacencyConfig& config) {
  for (const Eigen::Vector2d& p : points)
    if (const int room = room_on(building, storey, p, floor_m, config); room >= 0) return room;
  return -1;
}

}  // namespace

void find_virtual_edges(Building& building, const AdjacencyConfig& config) {
  const Surroundings around = surroundings_of(building, config);
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    building.rooms[i].virtual_edges = EdgeFinder(building, around, static_cast<int>(i), config).find();
}

void find_stair_rooms(Building& building, const AdjacencyConfig& config) {
  for (Stair& stair : building.stairs) {
    if (stair.flights.empty() || stair.rooms[0] >= 0 || stair.rooms[1] >= 0) continue;
    const StairFlight& first = stair.flights.front();
    const StairFlight& last = stair.flights.back();
    const Eigen::Vector2d up_first(std::cos(first.yaw), std::sin(first.yaw));
    const Eigen::Vector2d up_last(std::cos(last.yaw), std::sin(last.yaw));
    const Eigen::Vector2d top_edge = last.start + last.steps * last.run_m * up_last;
    stair.rooms[0] = room_at_one_of(
        building, stair.from, {first.start - config.step_m * up_first, first.start + 0.5 * first.run_m * up_first},
        first.z0_m, config);
    if (stair.to < 0) continue;
    stair.rooms[1] =
        room_at_one_of(building, stair.to, {top_edge + config.step_m * up_last, top_edge - 0.5 * last.run_m * up_last},
                       last.z0_m + last.steps * last.rise_m, config);
  }
}

}  // namespace plumbline::bim
