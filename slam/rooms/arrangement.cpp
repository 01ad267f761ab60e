// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr std::size_t most_lines = 24;
constexpr double piece_share = 0.5;  ///< of a piece that must be free
constexpr double least_piece_m2 = 1e-4;
constexpr double same_corner_m = 1e-6;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Middle of a line's stretch.
Vector2d middle(const FaceLine& line) { return -line.e * line.m + 0.5 * (line.s0 + line.s1) * line.along; }

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

/// Where several chains touch in a corner the sharpest turn to the left keeps them apart.
std::vector<Edge>::iterator next_of(const Edge& edge, std::vector<Edge>& open) {
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

}  // namespace

bool parallel(const FaceLine& a, const FaceLine& b, const RoomConfig& config) {
  return a.m.dot(b.m) > std::cos(config.opposed_deg * std::numbers::pi / 180.0);
}

double area_of(const Piece& piece) {
  double area = 0.0;
  for (const Edge& edge : piece) area += 0.5 * cross(edge.from, edge.to);
  return area;
}

std::vector<FaceLine> lines_of(const ClusterWalls& cluster_walls, std::span<const FaceLine> more) {
  std::vector<FaceLine> walls = cluster_walls.walls;
  std::stable_sort(walls.begin(), walls.end(),
                   [](const FaceLine& a, const FaceLine& b) { return a.support > b.support; });
  walls.insert(walls.end(), more.begin(), more.end());
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

Arrangement::Arrangement(const ClusterWalls& cluster_walls, std::vector<FaceLine> lines)
    : cluster_walls_(cluster_walls), lines_(std::move(lines)) {
  const double cell2 = cluster_walls.grid.frame.cell * cluster_walls.grid.frame.cell;
  for (const CellRun& run : cluster_walls.runs)
    for_each_stretch(run, [&](std::size_t from, std::size_t to, Sides sides) { cells_[sides] += to - from; });
  for (const auto& [sides, count] : cells_) {
    Piece piece = piece_of(sides);
    const double area = plumbline::slam::area_of(piece);
    if (area < least_piece_m2 || static_cast<double>(count) * cell2 < piece_share * area) continue;
    pieces_.emplace(sides, std::move(piece));
  }
}

Sides Arrangement::piece_at(const Vector2d& p) const {
  Sides sides = 0;
  for (std::size_t k = 0; k < lines_.size(); ++k)
    if (lines_[k].distance(p) >= 0.0) sides |= Sides{1} << k;
  return sides;
}

std::vector<std::vector<Sides>> Arrangement::components(const Joins& joins) const {
  std::vector<std::vector<Sides>> all;
  std::set<Sides> seen;
  for (const auto& [first, unused] : pieces_) {
    if (!seen.insert(first).second) continue;
    std::vector<Sides> part, next = {first};
    while (!next.empty()) {
      const Sides sides = next.back();
      next.pop_back();
      part.push_back(sides);
      for (const Edge& edge : pieces_.at(sides)) {
        const Sides other = behind(sides, edge);
        if (pieces_.contains(other) && !seen.contains(other) && joins(edge)) {
          seen.insert(other);
          next.push_back(other);
        }
      }
    }
    all.push_back(std::move(part));
  }
  return all;
}

double Arrangement::area_of(std::span<const Sides> pieces) const {
  double sum = 0.0;
  for (const Sides sides : pieces) sum += plumbline::slam::area_of(pieces_.at(sides));
  return sum;
}

void Arrangement::keep(std::span<const Sides> pieces) {
  std::map<Sides, Piece> kept;
  for (const Sides sides : pieces) kept.insert(pieces_.extract(sides));
  pieces_ = std::move(kept);
}

std::vector<Piece> Arrangement::borders() const {
  std::vector<Edge> open;
  for (const auto& [sides, piece] : pieces_)
    for (const Edge& edge : piece)
      if (!pieces_.contains(behind(sides, edge))) open.push_back(edge);
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

void Arrangement::for_each_stretch(const CellRun& run, const Visit& visit) const {
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
    if (changes[c].place > from) visit(from, changes[c].place, sides);
    from = changes[c].place;
    sides ^= changes[c].side;
  }
  visit(from, run.to, sides);
}

Piece Arrangement::piece_of(Sides sides) const {
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

}  // namespace plumbline::slam
