// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr std::size_t most_lines = 24;
constexpr double same_line_m = 0.35;  ///< two faces of one side this near are one side: pillars, cupboards, leaves
constexpr double piece_share = 0.5;   ///< of a piece that must be free
constexpr double ring_m2 = 1.0;       ///< what a ring goes round at least
constexpr double least_piece_m2 = 1e-4;
constexpr double same_corner_m = 1e-6;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// On which side of each line a point lies; bit k: the free side of line k.
using Sides = std::uint32_t;

struct Edge {
  std::size_t line = 0;
  Vector2d from, to;
};

/// A convex piece between the lines: its corners counter-clockwise, each with the line of the edge that it begins.
using Piece = std::vector<Edge>;

bool parallel(const FaceLine& a, const FaceLine& b, const RoomConfig& config) {
  return a.m.dot(b.m) > std::cos(config.opposed_deg * std::numbers::pi / 180.0);
}

/// Middle of a line's stretch.
Vector2d middle(const FaceLine& line) { return -line.e * line.m + 0.5 * (line.s0 + line.s1) * line.along; }

/// The faces that carry most of the border, without those that run beside a better one, and the cuts.
std::vector<FaceLine> lines_of(const ClusterWalls& cluster_walls) {
  std::vector<FaceLine> walls = cluster_walls.walls;
  std::stable_sort(walls.begin(), walls.end(),
                   [](const FaceLine& a, const FaceLine& b) { return a.support > b.support; });
  std::vector<FaceLine> lines;
  const auto add = [&](const FaceLine& line, const Vector2d& at) {
    const bool known = std::any_of(lines.begin(), lines.end(), [&](const FaceLine& l) {
      return parallel(l, line, cluster_walls.config) && std::abs(l.distance(at)) < same_line_m;
    });
    if (!known) lines.push_back(line);
  };
  for (const FaceLine& wall : walls)
    if (lines.size() < most_lines - 4) add(wall, middle(wall));
  if (lines.empty()) return lines;
  const Vector2d axis = lines.front().m;
  for (const Vector2d& m : {axis, Vector2d(-axis), Vector2d(-axis.y(), axis.x()), Vector2d(axis.y(), -axis.x())}) {
    Vector2d lowest = cluster_walls.cluster.center_M;
    for (const Vector2d& p : cluster_walls.border_M) {
      if (m.dot(p) < m.dot(lowest)) lowest = p;
    }
    add(cut_line(m, lowest - 0.5 * cluster_walls.grid.frame.cell * m), lowest);
  }
  return lines;
}

/// What of a piece lies on the given side of line k.
Piece clip(const Piece& piece, const FaceLine& line, std::size_t k, bool free_side) {
  const double sign = free_side ? 1.0 : -1.0;
  Piece kept;
  for (const Edge& edge : piece) {
    const double a = sign * line.distance(edge.from), b = sign * line.distance(edge.to);
    if (a < 0.0 && b < 0.0) continue;
    Edge part = edge;
    const Vector2d crossing = edge.from + (edge.to - edge.from) * (a / (a - b));
    if (a < 0.0) part.from = crossing;
    if (b < 0.0) part.to = crossing;
    if (!kept.empty() && (kept.back().to - part.from).norm() > same_corner_m)
      kept.push_back({k, kept.back().to, part.from});
    kept.push_back(part);
  }
  if (!kept.empty() && (kept.back().to - kept.front().from).norm() > same_corner_m)
    kept.push_back({k, kept.back().to, kept.front().from});
  return kept;
}

double area_of(const Piece& piece) {
  double area = 0.0;
  for (const Edge& edge : piece) area += 0.5 * cross(edge.from, edge.to);
  return area;
}

/// The lines' arrangement over one cluster.
class Arrangement {
 public:
  Arrangement(const ClusterWalls& cluster_walls, std::vector<FaceLine> lines)
      : cluster_walls_(cluster_walls), lines_(std::move(lines)) {
    const double cell2 = cluster_walls.grid.frame.cell * cluster_walls.grid.frame.cell;
    std::map<Sides, std::size_t> cells;
    for (const CellRun& run : cluster_walls.runs) count(run, cells);
    for (const auto& [sides, count] : cells) {
      const Piece piece = piece_of(sides);
      const double area = area_of(piece);
      if (area < least_piece_m2 || static_cast<double>(count) * cell2 < piece_share * area) continue;
      pieces_.emplace(sides, piece);
    }
    keep_largest();
    for (const auto& [sides, piece] : pieces_) inside_ += cells.at(sides);
  }

  [[nodiscard]] const std::vector<FaceLine>& lines() const { return lines_; }
  /// Cells of the cluster in the pieces that count.
  [[nodiscard]] std::size_t inside() const { return inside_; }
  [[nodiscard]] double area() const {
    double sum = 0.0;
    for (const auto& [sides, piece] : pieces_) sum += area_of(piece);
    return sum;
  }

  /// Closed chains of the edges between what counts and what does not, what counts to the left.
  [[nodiscard]] std::vector<Piece> borders() const {
    std::vector<Edge> open;
    for (const auto& [sides, piece] : pieces_)
      for (const Edge& edge : piece)
        if (!pieces_.contains(sides ^ (Sides{1} << edge.line))) open.push_back(edge);
    std::vector<Piece> chains;
    while (!open.empty()) {
      Piece chain = {open.back()};
      open.pop_back();
      while ((chain.back().to - chain.front().from).norm() > same_corner_m) {
        const auto next = next_of(chain.back(), open);
        if (next == open.end()) return {};  // a corner where pieces too small to count meet
        chain.push_back(*next);
        open.erase(next);
      }
      chains.push_back(std::move(chain));
    }
    return chains;
  }

 private:
  /// Adds a run's cells to those of their pieces.
  void count(const CellRun& run, std::map<Sides, std::size_t>& cells) const {
    struct Change {
      std::size_t place = 0;
      Sides side = 0;
    };
    std::array<Change, most_lines> changes;
    std::size_t n = 0;
    Sides sides = 0;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const Sides side = Sides{1} << k;
      const Stretch free =
          partition_run(cluster_walls_.grid.frame, run, lines_[k], [](double distance) { return distance >= 0.0; });
      if (free.cells() == 0) continue;
      if (free.from == run.from) sides |= side;
      if (free.cells() < run.to - run.from) changes[n++] = {free.from == run.from ? free.to : free.from, side};
    }
    std::sort(changes.begin(), changes.begin() + static_cast<std::ptrdiff_t>(n),
              [](const Change& a, const Change& b) { return a.place < b.place; });
    std::size_t from = run.from;
    for (std::size_t c = 0; c < n; ++c) {
      if (changes[c].place > from) cells[sides] += changes[c].place - from;
      from = changes[c].place;
      sides ^= changes[c].side;
    }
    cells[sides] += run.to - from;
  }

  [[nodiscard]] Piece piece_of(Sides sides) const {
    constexpr double far_m = 1e4;
    constexpr std::size_t nowhere = most_lines;
    const Vector2d c = cluster_walls_.cluster.center_M;
    const Vector2d corner[4] = {c + Vector2d(-far_m, -far_m), c + Vector2d(far_m, -far_m), c + Vector2d(far_m, far_m),
                                c + Vector2d(-far_m, far_m)};
    Piece piece;
    for (int i = 0; i < 4; ++i) piece.push_back({nowhere, corner[i], corner[(i + 1) % 4]});
    for (std::size_t k = 0; k < lines_.size() && !piece.empty(); ++k)
      piece = clip(piece, lines_[k], k, ((sides >> k) & 1U) != 0);
    return piece;
  }

  /// Of the pieces that hang together by edges the ones with most area (ties: the lowest).
  void keep_largest() {
    std::map<Sides, Piece> best;
    double most = 0.0;
    std::map<Sides, Piece> left = pieces_;
    while (!left.empty()) {
      std::map<Sides, Piece> part;
      std::vector<Sides> next = {left.begin()->first};
      double area = 0.0;
      while (!next.empty()) {
        const auto found = left.find(next.back());
        next.pop_back();
        if (found == left.end()) continue;
        for (const Edge& edge : found->second) next.push_back(found->first ^ (Sides{1} << edge.line));
        area += area_of(found->second);
        part.insert(left.extract(found));
      }
      if (area <= most) continue;
      most = area;
      best = std::move(part);
    }
    pieces_ = std::move(best);
  }

  /// Where several chains touch in a corner the sharpest turn to the left keeps them apart.
  static std::vector<Edge>::iterator next_of(const Edge& edge, std::vector<Edge>& open) {
    auto best = open.end();
    double sharpest = -std::numeric_limits<double>::infinity();
    const Vector2d d = edge.to - edge.from;
    for (auto it = open.begin(); it != open.end(); ++it) {
      if ((it->from - edge.to).norm() > same_corner_m) continue;
      const Vector2d e = it->to - it->from;
      const double turn = std::atan2(cross(d, e), d.dot(e));
      if (turn <= sharpest) continue;
      sharpest = turn;
      best = it;
    }
    return best;
  }

  const ClusterWalls& cluster_walls_;
  std::vector<FaceLine> lines_;
  std::map<Sides, Piece> pieces_;
  std::size_t inside_ = 0;
};

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

/// The wall that an edge lies on and the share of the edge on which it was seen: of the faces in one line the one seen
/// on most of it (ties: the first).
struct OnWall {
  int id = -1;
  double share = 0.0;
};

OnWall wall_of(const Edge& edge, const FaceLine& line, const ClusterWalls& cluster_walls) {
  const double length = (edge.to - edge.from).norm();
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

std::optional<Outline> outline_of(const ClusterWalls& cluster_walls) {
  const Arrangement arrangement(cluster_walls, lines_of(cluster_walls));
  if (arrangement.inside() == 0) return {};
  Outline outline;
  double length = 0.0, wall_share = 0.0, outer_area = 0.0;
  for (const Piece& border : arrangement.borders()) {
    const double area = area_of(border);
    if (area < 0.0) {
      outline.ring |= -area > ring_m2;
      continue;
    }
    if (area <= outer_area) continue;
    outer_area = area;
    outline.sides.clear();
    length = wall_share = 0.0;
    for (const Edge& edge : without_joints(border)) {
      const OnWall wall = wall_of(edge, arrangement.lines()[edge.line], cluster_walls);
      const double edge_m = (edge.to - edge.from).norm();
      outline.sides.push_back({wall.share >= cluster_walls.config.min_side_share ? wall.id : -1, edge.from});
      length += edge_m;
      wall_share += std::min(wall.share, 1.0) * edge_m;
    }
  }
  if (outline.sides.size() < 3) return {};
  const double cell2 = cluster_walls.grid.frame.cell * cluster_walls.grid.frame.cell;
  const auto inside = static_cast<double>(arrangement.inside());
  outline.fill = inside * cell2 / arrangement.area();
  outline.inside = inside / static_cast<double>(cluster_walls.cluster.cells.size());
  outline.wall_share = wall_share / length;
  return outline;
}

}  // namespace plumbline::slam
