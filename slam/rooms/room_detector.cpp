// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/room_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "slam/graph/graph.h"
#include "slam/rooms/cluster_walls.h"
#include "slam/rooms/corridor_segments.h"
#include "slam/rooms/merge_clusters.h"
#include "slam/rooms/outline.h"
#include "slam/rooms/overlap.h"
#include "slam/rooms/straight_edges.h"
#include "slam/rooms/wall_cuts.h"

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr double rad = std::numbers::pi / 180.0;
constexpr double fuller = 0.1;  ///< share by which a polygon must be freer than the rectangle it replaces

struct Pair {
  FaceLine a, b;
  [[nodiscard]] double support() const { return a.support + b.support; }
  [[nodiscard]] double width_at(const Vector2d& p) const { return a.distance(p) + b.distance(p); }
  [[nodiscard]] Vector2d across() const { return (a.m - b.m).normalized(); }
};

double share_between(const Pair& pair, const ClusterWalls& cluster_walls) {
  const auto between = [&](double distance) { return distance > -cluster_walls.config.slack_m; };
  std::size_t inside = 0;
  for (const CellRun& run : cluster_walls.runs)
    inside += partition_run(cluster_walls.grid.frame, run, pair.a, between)
                  .within(partition_run(cluster_walls.grid.frame, run, pair.b, between))
                  .cells();
  return static_cast<double>(inside) / static_cast<double>(cluster_walls.cluster.cells.size());
}

/// Opposed pairs around the cluster, perpendicular to `axis` where one is given; by falling support, ties: lower ids.
std::vector<Pair> opposed_pairs(const ClusterWalls& cluster_walls, const std::optional<Vector2d>& axis) {
  const RoomConfig& config = cluster_walls.config;
  const Vector2d& center = cluster_walls.cluster.center_M;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < cluster_walls.walls.size(); ++i)
    for (std::size_t j = i + 1; j < cluster_walls.walls.size(); ++j) {
      const Pair pair{cluster_walls.walls[i], cluster_walls.walls[j]};
      if (pair.a.m.dot(pair.b.m) > -std::cos(config.opposed_deg * rad)) continue;
      if (axis && std::abs(axis->dot(pair.across())) > std::sin(config.perpendicular_deg * rad)) continue;
      if (pair.a.distance(center) <= 0.0 || pair.b.distance(center) <= 0.0) continue;
      if (pair.width_at(center) < config.min_width_m) continue;
      pairs.push_back(pair);
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.support() > b.support(); });
  return pairs;
}

/// The best-supported of them that has the cluster between its walls.
std::optional<Pair> best_pair(const ClusterWalls& cluster_walls, const std::optional<Vector2d>& axis) {
  for (const Pair& pair : opposed_pairs(cluster_walls, axis))
    if (share_between(pair, cluster_walls) >= cluster_walls.config.inside_share) return pair;
  return {};
}

/// Free share of the polygon that four lines cut out, counting the cluster's own cells only.
double fill_of(const Polygon2& polygon, const std::array<FaceLine, 4>& sides, const ClusterWalls& cluster_walls) {
  const GridFrame& frame = cluster_walls.grid.frame;
  std::size_t inside = 0;
  for (const CellRun& run : cluster_walls.runs) {
    Stretch stretch{run.from, run.to};
    for (const FaceLine& side : sides)
      stretch = stretch.within(partition_run(frame, run, side, [](double distance) { return distance > 0.0; }));
    inside += stretch.cells();
  }
  return static_cast<double>(inside) * frame.cell * frame.cell / std::abs(signed_area(polygon));
}

/// [bavle2023, eq. 4] and the enclosure test of section IV-C: each side must be seen along part of its length.
std::optional<RoomCandidate> four_walls(const ClusterWalls& cluster_walls, const Pair& x, const Pair& y) {
  RoomCandidate room;
  room.kind = RoomKind::four_wall;
  room.planes = {x.a.id, x.b.id, y.a.id, y.b.id};
  room.polygon_M = counter_clockwise(
      {intersection(x.a, y.a), intersection(x.b, y.a), intersection(x.b, y.b), intersection(x.a, y.b)});
  room.center_M = 0.25 * (room.polygon_M[0] + room.polygon_M[1] + room.polygon_M[2] + room.polygon_M[3]);
  room.cluster_M = cluster_walls.cluster.center_M;
  const double wx = x.width_at(room.center_M), wy = y.width_at(room.center_M);
  const double share = cluster_walls.config.min_side_share;
  if (std::min(x.a.support, x.b.support) < share * wy || std::min(y.a.support, y.b.support) < share * wx) return {};
  room.fill = fill_of(room.polygon_M, {x.a, x.b, y.a, y.b}, cluster_walls);
  if (room.fill < cluster_walls.config.min_fill) return {};
  return room;
}

/// [bavle2023, eq. 5, 6]: between the walls, along them as far as the cluster reaches.
std::optional<RoomCandidate> two_walls(const ClusterWalls& cluster_walls, const Pair& pair) {
  if (std::min(pair.a.support, pair.b.support) < cluster_walls.config.min_two_wall_m) return {};
  const Vector2d n = pair.across();
  const Vector2d t(-n.y(), n.x());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const GridFrame& frame = cluster_walls.grid.frame;
  const auto inside = [](double distance) { return distance >= 0.0; };
  for (const CellRun& run : cluster_walls.runs) {
    const Stretch stretch = partition_run(frame, run, pair.a, inside).within(partition_run(frame, run, pair.b, inside));
    if (stretch.cells() == 0) continue;
    for (const std::size_t k : {stretch.from, stretch.to - 1}) {
      const double s = t.dot(frame.center(run.i + static_cast<int>(k - run.from), run.j));
      low = std::min(low, s);
      high = std::max(high, s);
    }
  }
  const double half = 0.5 * cluster_walls.grid.frame.cell;
  const FaceLine start = cut_line(t, (low - half) * t), end = cut_line(-t, (high + half) * t);
  RoomCandidate room;
  room.kind = RoomKind::two_wall;
  room.planes = {pair.a.id, pair.b.id};
  room.polygon_M = counter_clockwise(
      {intersection(pair.a, start), intersection(pair.b, start), intersection(pair.b, end), intersection(pair.a, end)});
  room.center_M = 0.25 * (room.polygon_M[0] + room.polygon_M[1] + room.polygon_M[2] + room.polygon_M[3]);
  room.cluster_M = room.center_M;
  room.fill = fill_of(room.polygon_M, {pair.a, pair.b, start, end}, cluster_walls);
  if (room.fill < cluster_walls.config.min_fill) return {};
  return room;
}

std::optional<RoomCandidate> rectangle(const ClusterWalls& cluster_walls) {
  const std::optional<Pair> x = best_pair(cluster_walls, std::nullopt);
  if (!x) return {};
  if (const std::optional<Pair> y = best_pair(cluster_walls, x->across()))
    if (std::optional<RoomCandidate> room = four_walls(cluster_walls, *x, *y)) return room;
  return two_walls(cluster_walls, *x);
}

/// Of an outline that is mostly free and encloses the cluster.
std::optional<RoomCandidate> polygon(const ClusterWalls& cluster_walls, const Outline& outline,
                                     std::size_t least_corners) {
  const RoomConfig& config = cluster_walls.config;
  if (outline.ring || outline.inside < config.inside_share || outline.fill < config.polygon_fill) return {};
  RoomCandidate room;
  room.kind = RoomKind::polygon;
  room.polygon_M = polygon_of(outline);
  room.fill = outline.fill;
  room.cluster_M = cluster_walls.cluster.center_M;
  set_polygon_planes(outline, cluster_walls.walls, room);
  if (room.corners.size() < least_corners || room.planes.size() > max_room_planes ||
      room.corners.size() > max_room_planes || !is_simple(room.polygon_M))
    return {};
  return room;
}

/// A room of more than four sides, most of its outline on walls.
std::optional<RoomCandidate> polygon(const ClusterWalls& cluster_walls, const Outline& outline) {
  constexpr std::size_t least_sides = 5, least_corners = 2;
  if (outline.sides.size() < least_sides || outline.wall_share < cluster_walls.config.polygon_wall_share) return {};
  return polygon(cluster_walls, outline, least_corners);
}

/// With the border alone that is no opening to other free space.
ClusterWalls without_openings(ClusterWalls cluster_walls) {
  const FreeGrid& grid = cluster_walls.grid;
  const double cell = grid.frame.cell;
  const auto free = [&](const Vector2d& p) {
    const auto at = grid.frame.find(p);
    return at && grid.free[*at] != 0;
  };
  std::erase_if(cluster_walls.border_M, [&](const Vector2d& p) {
    return free(p + Vector2d(cell, 0)) && free(p - Vector2d(cell, 0)) && free(p + Vector2d(0, cell)) &&
           free(p - Vector2d(0, cell));
  });
  return cluster_walls;
}

/// A room of any number of sides, of which walls that meet are but some: the robot saw the others in too few scans.
std::optional<RoomCandidate> partly_seen(const ClusterWalls& cluster_walls) {
  constexpr double least_wall_share = 0.2;
  const auto most = std::max_element(cluster_walls.walls.begin(), cluster_walls.walls.end(),
                                     [](const FaceLine& a, const FaceLine& b) { return a.support < b.support; });
  if (most == cluster_walls.walls.end()) return {};
  const ClusterWalls closed = without_openings(cluster_walls);
  const std::optional<Outline> outline = outline_of(closed, straight_edges(closed, most->m));
  if (!outline || outline->wall_share < least_wall_share || outline->edge_share < cluster_walls.config.edge_share)
    return {};
  return polygon(cluster_walls, *outline, 1);
}

/// Rooms in the straight parts of a ring.
std::vector<RoomCandidate> parts_of(const ClusterWalls& cluster_walls) {
  std::vector<RoomCandidate> rooms;
  for (const Cluster& part : corridor_segments(cluster_walls))
    if (std::optional<RoomCandidate> room =
            rectangle(make_cluster_walls(cluster_walls.grid, part, cluster_walls.walls, cluster_walls.config)))
      rooms.push_back(std::move(*room));
  return rooms;
}

std::vector<RoomCandidate> rooms_of(const ClusterWalls& cluster_walls) {
  const RoomConfig& config = cluster_walls.config;
  std::optional<RoomCandidate> room = rectangle(cluster_walls);
  const auto poor = [&] { return config.polygons && (!room || room->fill < config.rectangle_fill); };
  const auto take = [&](std::optional<RoomCandidate> other) {
    if (other && (!room || other->fill > room->fill + fuller)) room = std::move(other);
  };
  if (poor()) {
    const std::optional<Outline> outline = outline_of(cluster_walls);
    if (outline && outline->ring)
      if (std::vector<RoomCandidate> parts = parts_of(cluster_walls); parts.size() > 1) return parts;
    if (outline) take(polygon(cluster_walls, *outline));
  }
  if (poor()) take(partly_seen(cluster_walls));
  if (!room) return {};
  return {std::move(*room)};
}

/// Rooms of a cluster that may be an open plan.
std::vector<RoomCandidate> rooms_within(const ClusterWalls& cluster_walls, std::span<const FaceLine> faces,
                                        std::span<const Vector2d> visited_M) {
  std::vector<Cluster> parts;
  if (cluster_walls.config.polygons) parts = cut_along_walls(cluster_walls, faces, visited_M);
  if (parts.empty()) return rooms_of(cluster_walls);
  std::vector<RoomCandidate> rooms;
  for (const Cluster& part : parts)
    for (RoomCandidate& room : rooms_of(make_cluster_walls(cluster_walls.grid, part, faces, cluster_walls.config)))
      rooms.push_back(std::move(room));
  return rooms;
}

double overlap_of(const Polygon2& a, const Polygon2& b) {
  return overlap_area(a, b) / std::min(std::abs(signed_area(a)), std::abs(signed_area(b)));
}

bool better(const RoomCandidate& a, const RoomCandidate& b) {
  const auto rank = [](RoomKind kind) { return kind == RoomKind::four_wall ? 0 : kind == RoomKind::polygon ? 1 : 2; };
  if (a.kind != b.kind) return rank(a.kind) < rank(b.kind);
  return a.fill > b.fill;
}

/// Of overlapping rooms keeps the better one (ties: the earlier). One that gives way drops none in turn.
void drop_overlapping(std::vector<RoomCandidate>& rooms, double max_overlap) {
  std::vector<std::size_t> order(rooms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return better(rooms[i], rooms[j]); });
  std::vector<std::size_t> kept;
  for (const std::size_t i : order)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](std::size_t k) { return overlap_of(rooms[i].polygon_M, rooms[k].polygon_M) > max_overlap; }))
      kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  std::vector<RoomCandidate> left;
  for (const std::size_t i : kept) left.push_back(std::move(rooms[i]));
  rooms = std::move(left);
}

/// Direction of a two-wall room's walls: the sides of its polygon that lie on them are those along which both rooms are
/// set apart.
Vector2d along_both(const RoomCandidate& a, const RoomCandidate& b) {
  const Vector2d t = (a.polygon_M[1] - a.polygon_M[0]).normalized();
  const Vector2d s(-t.y(), t.x());
  const Vector2d apart = b.center_M - a.center_M;
  return std::abs(apart.dot(t)) > std::abs(apart.dot(s)) ? t : s;
}

/// A two-wall room as far as two of them reach that lie between the same walls.
RoomCandidate together(const RoomCandidate& a, const RoomCandidate& b) {
  const Vector2d along = along_both(a, b);
  std::vector<Vector2d> corners(a.polygon_M.begin(), a.polygon_M.end());
  corners.insert(corners.end(), b.polygon_M.begin(), b.polygon_M.end());
  std::stable_sort(corners.begin(), corners.end(),
                   [&](const Vector2d& p, const Vector2d& q) { return along.dot(p) < along.dot(q); });
  const Vector2d &p0 = corners[0], &p1 = corners[1], &q0 = corners[corners.size() - 2], &q1 = corners.back();
  const bool crossed = (p1 - p0).dot(q1 - q0) < 0.0;
  RoomCandidate room = a;
  room.polygon_M = counter_clockwise({p0, p1, crossed ? q0 : q1, crossed ? q1 : q0});
  room.center_M = 0.25 * (p0 + p1 + q0 + q1);
  room.cluster_M = room.center_M;
  const auto area = [](const RoomCandidate& r) { return std::abs(signed_area(r.polygon_M)); };
  room.fill = std::min(1.0, (a.fill * area(a) + b.fill * area(b)) / area(room));
  return room;
}

/// How far two rooms between the same walls reach past each other, m.
double reach_past(const RoomCandidate& a, const RoomCandidate& b) {
  const Vector2d along = along_both(a, b);
  const auto ends = [&along](const RoomCandidate& room) {
    std::array<double, 2> low_high = {along.dot(room.polygon_M[0]), along.dot(room.polygon_M[0])};
    for (const Vector2d& p : room.polygon_M)
      low_high = {std::min(low_high[0], along.dot(p)), std::max(low_high[1], along.dot(p))};
    return low_high;
  };
  const std::array<double, 2> of_a = ends(a), of_b = ends(b);
  return std::min(of_a[1], of_b[1]) - std::max(of_a[0], of_b[0]);
}

/// A hall whose free space a flight of stairs cuts askew falls into clusters that reach past each other between the
/// same walls; those on both sides of a partition do not, but for the cell that either is rounded up by.
void merge_two_wall_rooms(std::vector<RoomCandidate>& rooms, double cell_m) {
  constexpr double least_cells = 3.0;
  for (std::size_t i = 0; i < rooms.size(); ++i)
    for (std::size_t j = i + 1; j < rooms.size();) {
      const bool one = rooms[i].kind == RoomKind::two_wall && rooms[j].kind == RoomKind::two_wall &&
                       rooms[i].planes == rooms[j].planes && reach_past(rooms[i], rooms[j]) > least_cells * cell_m;
      if (!one) {
        ++j;
        continue;
      }
      rooms[i] = together(rooms[i], rooms[j]);
      rooms.erase(rooms.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
}

}  // namespace

std::vector<RoomCandidate> detect_rooms(const FreeGrid& grid, std::span<const Cluster> clusters,
                                        std::span<const PlaneNode> walls_M, std::span<const Vector2d> visited_M,
                                        const RoomConfig& config) {
  std::vector<FaceLine> faces;
  for (const PlaneNode& wall : walls_M) faces.push_back(face_line(wall));
  const auto entered = [&](const RoomCandidate& room) {
    return std::any_of(visited_M.begin(), visited_M.end(),
                       [&](const Vector2d& p) { return contains(room.polygon_M, p); });
  };
  std::vector<RoomCandidate> rooms;
  /// Whether it holds a room that was entered, or a rectangle or corridor that was not.
  const auto add_rooms = [&](const Cluster& cluster) {
    bool any = false;
    for (RoomCandidate& room : rooms_within(make_cluster_walls(grid, cluster, faces, config), faces, visited_M)) {
      const bool kept = !config.entered_only || entered(room);
      any |= kept || room.kind != RoomKind::polygon;
      if (kept) rooms.push_back(std::move(room));
    }
    return any;
  };
  const std::vector<Cluster> joined = config.polygons ? merge_clusters(grid, clusters, faces, config)
                                                      : std::vector<Cluster>(clusters.begin(), clusters.end());
  std::vector<Cluster> left;
  for (const Cluster& cluster : joined)
    if (!add_rooms(cluster)) left.push_back(cluster);
  // A hall that pillars and furniture cut into parts of which none is a room.
  if (config.polygons)
    for (const Cluster& hall : merge_wide(grid, left, config.wide_m)) (void)add_rooms(hall);
  if (config.polygons) merge_two_wall_rooms(rooms, grid.frame.cell);
  drop_overlapping(rooms, config.max_overlap);
  return rooms;
}

std::vector<int> associate_rooms(std::span<const Polygon2> known_M, std::span<const RoomCandidate> candidates,
                                 double overlap) {
  struct Match {
    double overlap;
    std::size_t known, candidate;
  };
  std::vector<Match> matches;
  for (std::size_t k = 0; k < known_M.size(); ++k)
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const double shared = overlap_of(known_M[k], candidates[c].polygon_M);
      if (shared > overlap) matches.push_back({shared, k, c});
    }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.overlap > b.overlap; });
  std::vector<int> result(candidates.size(), -1);
  std::vector<bool> taken(known_M.size(), false);
  for (const Match& m : matches) {
    if (taken[m.known] || result[m.candidate] >= 0) continue;
    taken[m.known] = true;
    result[m.candidate] = static_cast<int>(m.known);
  }
  return result;
}

}  // namespace plumbline::slam
