// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/wall_cuts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "slam/rooms/arrangement.h"

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

Eigen::AlignedBox2d box_of(const FaceLine& face) {
  Eigen::AlignedBox2d box(Vector2d(face.s0 * face.along - face.e * face.m));
  return box.extend(Vector2d(face.s1 * face.along - face.e * face.m));
}

/// Faces that touch the cluster's surroundings.
std::vector<FaceLine> near(const ClusterWalls& cluster_walls, std::span<const FaceLine> faces) {
  const Vector2d reach = Vector2d::Constant(same_line_m);
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : cluster_walls.border_M) box.extend(p);
  if (box.isEmpty()) return {};
  box = {box.min() - reach, box.max() + reach};
  std::vector<FaceLine> kept;
  for (const FaceLine& face : faces)
    if (box.intersects(box_of(face))) kept.push_back(face);
  return kept;
}

/// Those of them on which at least min_support_m of cells lie, as where rays pass through a pane.
std::vector<FaceLine> amid(const ClusterWalls& cluster_walls, std::span<const FaceLine> faces) {
  const GridFrame& frame = cluster_walls.grid.frame;
  const std::vector<std::size_t>& cells = cluster_walls.cluster.cells;
  std::vector<FaceLine> kept;
  for (const FaceLine& face : faces) {
    double inside_m = 0.0;
    for (double s = face.s0; s < face.s1; s += frame.cell)
      if (const auto cell = frame.find(s * face.along - face.e * face.m);
          cell && std::binary_search(cells.begin(), cells.end(), *cell))
        inside_m += frame.cell;
    if (inside_m >= cluster_walls.config.min_support_m) kept.push_back(face);
  }
  return kept;
}

/// What of an edge walls stand on, m.
struct WallLength {
  double seen = 0.0;    ///< along their planes, doors and panes between their parts included
  double closed = 0.0;  ///< where they part free space on both of their sides, as no cupboard does
};

/// Whether a cell at p, or beside it along n, is not free, and free space lies behind it on both sides.
bool closed_at(const FreeGrid& grid, const Vector2d& p, const Vector2d& n) {
  constexpr int thickest_cells = 5;
  const auto free = [&](int k) {
    const auto cell = grid.frame.find(p + k * grid.frame.cell * n);
    return cell && grid.free[*cell] != 0;
  };
  if (free(-1) && free(0) && free(1)) return false;
  bool before = false, behind = false;
  for (int k = 1; k <= thickest_cells; ++k) {
    before |= free(-k);
    behind |= free(k);
  }
  return before && behind;
}

/// Of the walls beside the edge, whatever side of them is seen.
WallLength walls_on(const Edge& edge, const FaceLine& line, std::span<const FaceLine> faces,
                    const ClusterWalls& cluster_walls) {
  enum : std::uint8_t { none, seen, closed };
  const FreeGrid& grid = cluster_walls.grid;
  const double cell = grid.frame.cell, length = edge.length();
  const Vector2d along = (edge.to - edge.from) / length, middle = 0.5 * (edge.from + edge.to);
  const double opposed = std::cos(cluster_walls.config.opposed_deg * std::numbers::pi / 180.0);
  std::vector<std::uint8_t> bins(static_cast<std::size_t>(std::ceil(length / cell)), none);
  for (const FaceLine& face : faces) {
    if (std::abs(face.m.dot(line.m)) < opposed || std::abs(face.distance(middle)) > same_line_m) continue;
    for (std::size_t k = 0; k < bins.size(); ++k) {
      const Vector2d p = edge.from + std::min((static_cast<double>(k) + 0.5) * cell, length) * along;
      const double s = face.along.dot(p);
      if (bins[k] == closed || s < face.s0 || s > face.s1) continue;
      bins[k] = closed_at(grid, s * face.along - face.e * face.m, face.m) ? closed : seen;
    }
  }
  const double bin_m = length / static_cast<double>(bins.size());
  const auto empty = static_cast<std::size_t>(std::count(bins.begin(), bins.end(), none));
  return {bin_m * static_cast<double>(bins.size() - empty),
          bin_m * static_cast<double>(std::count(bins.begin(), bins.end(), closed))};
}

/// Parts of a cluster, in pieces of an arrangement, that are joined one by one.
class Parts {
 public:
  Parts(const Arrangement& arrangement, std::span<const FaceLine> faces, const ClusterWalls& cluster_walls)
      : arrangement_(arrangement), share_(cluster_walls.config.cut_share) {
    const auto walls = [&](const Edge& edge) {
      return walls_on(edge, arrangement.lines()[edge.line], faces, cluster_walls);
    };
    parts_ = arrangement.components([&](const Edge& edge) { return walls(edge).seen < share_ * edge.length(); });
    for (std::size_t part = 0; part < parts_.size(); ++part)
      for (const Sides piece : parts_[part]) part_of_[piece] = part;
    if (parts_.size() < 2) return;
    for (const auto& [sides, piece] : arrangement.pieces())
      for (const Edge& edge : piece) {
        const auto other = part_of_.find(Arrangement::behind(sides, edge));
        if (other != part_of_.end() && other->second == part_of_.at(sides)) continue;
        const WallLength wall = walls(edge);
        if (other == part_of_.end())
          outer_[part_of_.at(sides)] += Border{{edge.length(), wall.seen, wall.closed}};
        else
          borders_[{part_of_.at(sides), other->second}] += Border{{edge.length(), wall.seen, wall.closed}};
      }
  }

  /// Joins the smallest part below so many cells with the neighbour behind the longest opening, again and again (ties:
  /// the first). What has no neighbour is dropped.
  void join_small(std::size_t least_cells) {
    for (;;) {
      std::size_t smallest = parts_.size();
      for (std::size_t part = 0; part < parts_.size(); ++part)
        if (!parts_[part].empty() && cells(part) < least_cells &&
            (smallest == parts_.size() || cells(part) < cells(smallest)))
          smallest = part;
      if (smallest == parts_.size()) return;
      std::size_t best = parts_.size();
      double longest = -1.0;
      for (const auto& [pair, border] : borders_)
        if (pair[0] == smallest && border.length() - border.seen() > longest) {
          longest = border.length() - border.seen();
          best = pair[1];
        }
      if (best < parts_.size())
        join(smallest, best);
      else
        drop(smallest);
    }
  }

  /// Joins parts between which free space is open, as over steps, rails and tables. It may be open to the outside, as
  /// through glass, where planes are seen on most of the border: a part that the robot did not enter and that has no
  /// walls round most of it.
  void join_open(std::span<const Vector2d> visited_M) {
    constexpr double most = 0.5, glass_share = 0.6;
    std::set<std::size_t> entered;
    for (const Vector2d& p : visited_M)
      if (const auto part = part_of_.find(arrangement_.piece_at(p)); part != part_of_.end())
        entered.insert(part->second);
    const auto outside = [&](std::size_t part) {
      return !entered.contains(part) && outer_[part].seen() < most * outer_[part].length();
    };
    const auto open = [&](const auto& item) {
      const auto& [pair, border] = item;
      const bool glass = border.seen() >= glass_share * border.length() && (outside(pair[0]) || outside(pair[1]));
      return border.closed() < share_ * border.length() && !glass;
    };
    for (auto found = std::find_if(borders_.begin(), borders_.end(), open); found != borders_.end();
         found = std::find_if(borders_.begin(), borders_.end(), open)) {
      if (entered.contains(found->first[1])) entered.insert(found->first[0]);
      join(found->first[1], found->first[0]);
    }
  }

  [[nodiscard]] const std::map<Sides, std::size_t>& part_of() const { return part_of_; }
  [[nodiscard]] std::size_t count() const { return parts_.size(); }

 private:
  using Pair = std::array<std::size_t, 2>;
  /// Length of a border, and of it what walls are seen on and what they close, m.
  struct Border {
    std::array<double, 3> m = {0.0, 0.0, 0.0};
    [[nodiscard]] double length() const { return m[0]; }
    [[nodiscard]] double seen() const { return m[1]; }
    [[nodiscard]] double closed() const { return m[2]; }
    Border& operator+=(const Border& other) {
      for (std::size_t k = 0; k < m.size(); ++k) m[k] += other.m[k];
      return *this;
    }
  };

  [[nodiscard]] std::size_t cells(std::size_t part) const {
    std::size_t sum = 0;
    for (const Sides piece : parts_[part]) sum += arrangement_.cells_in(piece);
    return sum;
  }

  /// Makes `part` one with `other`, whose index stays.
  void join(std::size_t part, std::size_t other) {
    for (const Sides piece : parts_[part]) part_of_[piece] = other;
    parts_[other].insert(parts_[other].end(), parts_[part].begin(), parts_[part].end());
    for (std::size_t third = 0; third < parts_.size(); ++third)
      if (const auto border = borders_.find({part, third}); border != borders_.end() && third != other) {
        borders_[{other, third}] += border->second;
        borders_[{third, other}] += border->second;
      }
    outer_[other] += outer_[part];
    forget(part);
  }
  void drop(std::size_t part) {
    for (const Sides piece : parts_[part]) part_of_.erase(piece);
    forget(part);
  }
  void forget(std::size_t part) {
    parts_[part].clear();
    std::erase_if(borders_, [&](const auto& b) { return b.first[0] == part || b.first[1] == part; });
  }

  const Arrangement& arrangement_;
  double share_;
  std::vector<std::vector<Sides>> parts_;
  std::map<Sides, std::size_t> part_of_;
  std::map<Pair, Border> borders_;
  std::map<std::size_t, Border> outer_;  ///< of each part, where nothing lies behind
};

}  // namespace

std::vector<Cluster> cut_along_walls(const ClusterWalls& cluster_walls, std::span<const FaceLine> faces,
                                     std::span<const Vector2d> visited_M) {
  const RoomConfig& config = cluster_walls.config;
  const double cell = cluster_walls.grid.frame.cell;
  const std::vector<FaceLine> around = near(cluster_walls, faces);
  const Arrangement arrangement(cluster_walls, lines_of(cluster_walls, amid(cluster_walls, around)));
  Parts parts(arrangement, around, cluster_walls);
  if (parts.count() < 2) return {};
  parts.join_small(static_cast<std::size_t>(config.min_part_m2 / (cell * cell)));
  parts.join_open(visited_M);
  std::vector<std::vector<std::size_t>> cells(parts.count());
  for (const CellRun& run : cluster_walls.runs)
    arrangement.for_each_stretch(run, [&](std::size_t from, std::size_t to, Sides piece) {
      const auto part = parts.part_of().find(piece);
      if (part == parts.part_of().end()) return;
      const auto first = cluster_walls.cluster.cells.begin();
      cells[part->second].insert(cells[part->second].end(), first + static_cast<std::ptrdiff_t>(from),
                                 first + static_cast<std::ptrdiff_t>(to));
    });
  std::vector<Cluster> clusters;
  for (std::vector<std::size_t>& part : cells)
    if (!part.empty()) clusters.push_back(cluster_of(cluster_walls.grid, std::move(part)));
  if (clusters.size() < 2) clusters.clear();
  return clusters;
}

}  // namespace plumbline::slam
