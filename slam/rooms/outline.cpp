// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/outline.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "slam/rooms/arrangement.h"

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr double ring_m2 = 1.0;  ///< what a ring goes round at least

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Edges of one line that follow each other become one; a chain begins where its line changes.
Piece without_joints(const Piece& chain) {
  Piece merged;
  for (const Edge& edge : chain) {
    if (!merged.empty() && merged.back().line == edge.line)
      merged.back().to = edge.to;
    else
      merged.push_back(edge);
  }
  if (merged.size() > 1 && merged.back().line == merged.front().line) {
    merged.front().from = merged.back().from;
    merged.pop_back();
  }
  return merged;
}

/// Of the pieces that hang together by edges the ones with most area (ties: the lowest).
void keep_largest(Arrangement& arrangement) {
  std::vector<Sides> largest;
  double most = 0.0;
  for (std::vector<Sides>& part : arrangement.components([](const Edge&) { return true; })) {
    const double area = arrangement.area_of(part);
    if (area <= most) continue;
    most = area;
    largest = std::move(part);
  }
  arrangement.keep(largest);
}

/// The wall that an edge lies on and the share of the edge on which it was seen: of the faces in one line the one seen
/// on most of it (ties: the first).
struct OnWall {
  int id = -1;
  double share = 0.0;
};

OnWall wall_of(const Edge& edge, const FaceLine& line, const ClusterWalls& cluster_walls) {
  const double length = edge.length();
  const Vector2d at = 0.5 * (edge.from + edge.to);
  OnWall best;
  for (const FaceLine& face : cluster_walls.walls) {
    if (!parallel(face, line, cluster_walls.config) || std::abs(face.distance(at)) > same_line_m) continue;
    const double a = face.along.dot(edge.from), b = face.along.dot(edge.to);
    const double from = std::max(face.s0, std::min(a, b)), to = std::min(face.s1, std::max(a, b));
    const double share = border_on(face, from, to, cluster_walls) / length;
    if (share > best.share) best = {face.id, share};
  }
  return best;
}

/// Share of an edge along which free space ends, by places of 1.5 cells: the cells of a border lie in a chain, so at
/// most a diagonal apart.
double free_edge_share(const Edge& edge, const FaceLine& line, const ClusterWalls& cluster_walls) {
  const RoomConfig& config = cluster_walls.config;
  const double place_m = 1.5 * cluster_walls.grid.frame.cell, length = edge.length();
  const Vector2d along = (edge.to - edge.from) / length;
  std::set<int> places;
  for (const Vector2d& p : cluster_walls.border_M) {
    const double distance = line.distance(p), s = along.dot(p - edge.from);
    if (distance >= -config.slack_m && distance <= config.reach_m && s >= 0.0 && s <= length)
      places.insert(static_cast<int>(s / place_m));
  }
  return place_m * static_cast<double>(places.size()) / length;
}

}  // namespace

Polygon2 polygon_of(const Outline& outline) {
  Polygon2 polygon;
  for (const OutlineSide& side : outline.sides) polygon.push_back(side.from_M);
  return polygon;
}

void set_polygon_planes(const Outline& outline, std::span<const FaceLine> walls, RoomCandidate& room) {
  constexpr double least_sine = 0.1;
  const std::size_t n = outline.sides.size();
  const auto place = [&](int wall) {
    const auto known = std::find(room.planes.begin(), room.planes.end(), wall);
    if (known == room.planes.end()) room.planes.push_back(wall);
    return static_cast<int>(std::find(room.planes.begin(), room.planes.end(), wall) - room.planes.begin());
  };
  const auto normal = [&](int wall) {
    return std::find_if(walls.begin(), walls.end(), [&](const FaceLine& face) { return face.id == wall; })->m;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const int wall = outline.sides[k].wall, next = outline.sides[(k + 1) % n].wall;
    if (wall < 0) continue;
    const int here = place(wall);
    if (next < 0 || next == wall || std::abs(cross(normal(wall), normal(next))) < least_sine) continue;
    room.corners.push_back({here, place(next)});
    room.center_M += outline.sides[(k + 1) % n].from_M;
  }
  if (!room.corners.empty()) room.center_M /= static_cast<double>(room.corners.size());
}

std::optional<Outline> outline_of(const ClusterWalls& cluster_walls, std::span<const FaceLine> edges) {
  Arrangement arrangement(cluster_walls, lines_of(cluster_walls, edges));
  keep_largest(arrangement);
  if (arrangement.pieces().empty()) return {};
  Outline outline;
  double length = 0.0, wall_share = 0.0, edge_share = 0.0, outer_area = 0.0;
  for (const Piece& border : arrangement.borders()) {
    const double area = area_of(border);
    if (area < 0.0) {
      outline.ring |= -area > ring_m2;
      continue;
    }
    if (area <= outer_area) continue;
    outer_area = area;
    outline.sides.clear();
    length = wall_share = edge_share = 0.0;
    for (const Edge& edge : without_joints(border)) {
      const FaceLine& line = arrangement.lines()[edge.line];
      const OnWall wall = wall_of(edge, line, cluster_walls);
      const double edge_m = edge.length();
      outline.sides.push_back({wall.share >= cluster_walls.config.min_side_share ? wall.id : -1, edge.from});
      length += edge_m;
      wall_share += std::min(wall.share, 1.0) * edge_m;
      edge_share += std::min(std::max(wall.share, free_edge_share(edge, line, cluster_walls)), 1.0) * edge_m;
    }
  }
  if (outline.sides.size() < 3) return {};
  const double cell2 = cluster_walls.grid.frame.cell * cluster_walls.grid.frame.cell;
  double inside = 0.0, area = 0.0;
  for (const auto& [sides, piece] : arrangement.pieces()) {
    inside += static_cast<double>(arrangement.cells_in(sides));
    area += area_of(piece);
  }
  outline.fill = inside * cell2 / area;
  outline.inside = inside / static_cast<double>(cluster_walls.cluster.cells.size());
  outline.wall_share = wall_share / length;
  outline.edge_share = edge_share / length;
  return outline;
}

}  // namespace plumbline::slam
