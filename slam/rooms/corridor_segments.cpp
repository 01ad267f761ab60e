// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/corridor_segments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr std::size_t most_parts = 16;

/// One bit a cell of the cluster, by its index there.
using Mask = std::vector<std::uint64_t>;

/// Indices [from, to).
void set(Mask& mask, std::size_t from, std::size_t to) {
  while (from < to) {
    const std::size_t word = from / 64, end = std::min(to, 64 * (word + 1));
    mask[word] |= ~std::uint64_t{0} >> (64 - (end - from)) << (from % 64);
    from = end;
  }
}
void drop(Mask& mask, std::size_t k) { mask[k / 64] &= ~(std::uint64_t{1} << (k % 64)); }

/// Cells side by side in one row of the grid: indices [from, to) in the cluster.
struct CellSpan {
  std::size_t from = 0, to = 0;
};

/// Cells that hang together.
struct Part {
  std::vector<CellSpan> runs;  ///< rising
  std::size_t cells = 0;
};

/// Two opposed walls, by their indices in ClusterWalls::walls.
struct Gap {
  std::size_t a = 0, b = 0;
  std::size_t cells = 0;  ///< of those left, how many lie between the walls
  bool known = false;     ///< whether `stretch` is what so many cells give
  Part stretch;
};

/// Stretches between opposed walls, of what is left of a cluster.
class CorridorSegments {
 public:
  explicit CorridorSegments(const ClusterWalls& cluster_walls) : cluster_walls_(cluster_walls) {
    centers_.reserve(cluster_walls.cluster.cells.size());
    for (const CellRun& run : cluster_walls.runs)
      for (std::size_t k = run.from; k < run.to; ++k)
        centers_.push_back(cluster_walls.grid.frame.center(run.i + static_cast<int>(k - run.from), run.j));
    left_.assign((centers_.size() + 63) / 64, ~std::uint64_t{0});
    for (const FaceLine& wall : cluster_walls.walls) sides_.push_back(free_side(wall));
    find_row_starts();
    find_gaps();
  }

  /// The largest (ties: between the walls with more cells between them, then lower indices).
  [[nodiscard]] Part largest() {
    for (Gap& gap : gaps_) {
      const std::size_t before = std::exchange(gap.cells, count(gap));
      gap.known &= gap.cells == before;  // cells only go
    }
    std::vector<Gap*> order;
    for (Gap& gap : gaps_) order.push_back(&gap);
    std::stable_sort(order.begin(), order.end(), [](const Gap* p, const Gap* q) { return p->cells > q->cells; });
    const Gap* best = nullptr;
    for (Gap* gap : order) {
      const std::size_t most = best == nullptr ? 0 : best->stretch.cells;
      if (gap->cells <= most) break;
      if (!gap->known) gap->stretch = stretch(*gap);
      gap->known = true;
      if (gap->stretch.cells > most) best = gap;
    }
    return best == nullptr ? Part{} : best->stretch;
  }

  void take(const Part& part) {
    for (const CellSpan& run : part.runs)
      for (std::size_t k = run.from; k < run.to; ++k) drop(left_, k);
  }

 private:
  /// Which of the cells lie on the free side of a wall.
  [[nodiscard]] Mask free_side(const FaceLine& wall) const {
    Mask mask(left_.size(), 0);
    const auto free = [&](double distance) { return distance > -cluster_walls_.config.slack_m; };
    for (const CellRun& run : cluster_walls_.runs) {
      const Stretch stretch = partition_run(cluster_walls_.grid.frame, run, wall, free);
      set(mask, stretch.from, stretch.to);
    }
    return mask;
  }

  void find_row_starts() {
    row_starts_.assign(left_.size(), 0);
    for (const CellRun& run : cluster_walls_.runs) set(row_starts_, run.from, run.from + 1);
  }

  void find_gaps() {
    const double opposed = -std::cos(cluster_walls_.config.opposed_deg * std::numbers::pi / 180.0);
    for (std::size_t i = 0; i < cluster_walls_.walls.size(); ++i)
      for (std::size_t j = i + 1; j < cluster_walls_.walls.size(); ++j)
        if (cluster_walls_.walls[i].m.dot(cluster_walls_.walls[j].m) <= opposed) gaps_.push_back({i, j, 0, false, {}});
  }

  [[nodiscard]] std::size_t count(const Gap& gap) const {
    std::size_t cells = 0;
    for (std::size_t w = 0; w < left_.size(); ++w)
      cells += static_cast<std::size_t>(std::popcount(sides_[gap.a][w] & sides_[gap.b][w] & left_[w]));
    return cells;
  }

  /// The largest component of what is between the gap's walls, or nothing where it is not mostly free.
  [[nodiscard]] Part stretch(const Gap& gap) const {
    Mask between(left_.size());
    for (std::size_t w = 0; w < left_.size(); ++w) between[w] = sides_[gap.a][w] & sides_[gap.b][w] & left_[w];
    Part part = largest_component(between);
    if (part.cells == 0) return part;
    const FaceLine &a = cluster_walls_.walls[gap.a], &b = cluster_walls_.walls[gap.b];
    double low = std::numeric_limits<double>::infinity(), high = -low, width = 0.0;
    for (const CellSpan& run : part.runs) {
      for (const std::size_t end : {run.from, run.to - 1}) {
        low = std::min(low, a.along.dot(centers_[end]));
        high = std::max(high, a.along.dot(centers_[end]));
      }
      // Along a row the width changes linearly.
      const Vector2d &first = centers_[run.from], &last = centers_[run.to - 1];
      width += 0.5 * static_cast<double>(run.to - run.from) *
               (a.distance(first) + b.distance(first) + a.distance(last) + b.distance(last));
    }
    width /= static_cast<double>(part.cells);
    const double cell = cluster_walls_.grid.frame.cell;
    const double free_m2 = cell * cell * static_cast<double>(part.cells);
    const bool mostly_free = free_m2 >= cluster_walls_.config.polygon_fill * width * (high - low + cell);
    if (width < cluster_walls_.config.min_width_m || high - low < width || !mostly_free) part = {};
    return part;
  }

  /// Rising.
  [[nodiscard]] std::vector<CellSpan> runs_of(const Mask& mask) const {
    std::vector<CellSpan> runs;
    std::uint64_t last = 0;  // cell of the word before
    for (std::size_t w = 0; w < mask.size(); ++w) {
      std::uint64_t starts = mask[w] & (~(mask[w] << 1U | last) | row_starts_[w]);
      last = mask[w] >> 63U;
      for (; starts != 0; starts &= starts - 1)
        runs.push_back({64 * w + static_cast<std::size_t>(std::countr_zero(starts)), 0});
    }
    for (CellSpan& run : runs) run.to = end_of(mask, run.from);
    return runs;
  }

  /// The first index behind `from` that is not in the mask or begins a row.
  [[nodiscard]] std::size_t end_of(const Mask& mask, std::size_t from) const {
    std::uint64_t later = ~std::uint64_t{1} << (from % 64);
    for (std::size_t w = from / 64; w < mask.size(); ++w, later = ~std::uint64_t{0})
      if (const std::uint64_t ends = (~mask[w] | row_starts_[w]) & later; ends != 0)
        return std::min(64 * w + static_cast<std::size_t>(std::countr_zero(ends)), centers_.size());
    return centers_.size();
  }

  /// What hangs together by 4-neighbours and is largest (ties: the one with the lowest cell).
  [[nodiscard]] Part largest_component(const Mask& mask) const {
    const std::vector<CellSpan> runs = runs_of(mask);
    const std::vector<std::size_t> root = join(runs);
    std::vector<std::size_t> count(runs.size(), 0);
    for (std::size_t r = 0; r < runs.size(); ++r) count[root[r]] += runs[r].to - runs[r].from;
    const auto most = std::max_element(count.begin(), count.end());
    Part part;
    if (most == count.end()) return part;
    part.cells = *most;
    for (std::size_t r = 0; r < runs.size(); ++r)
      if (root[r] == static_cast<std::size_t>(most - count.begin())) part.runs.push_back(runs[r]);
    return part;
  }

  /// Of each run the lowest one that it hangs together with.
  [[nodiscard]] std::vector<std::size_t> join(const std::vector<CellSpan>& runs) const {
    const std::vector<std::size_t>& cells = cluster_walls_.cluster.cells;
    const auto width = static_cast<std::size_t>(cluster_walls_.grid.frame.nx);
    std::vector<std::size_t> root(runs.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&root](std::size_t r) {
      while (root[r] != r) r = root[r] = root[root[r]];
      return r;
    };
    std::size_t above = 0;  // the first run that does not end before what lies over this one
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const std::size_t first = cells[runs[r].from], last = cells[runs[r].to - 1];
      while (cells[runs[above].to - 1] + width < first) ++above;
      for (std::size_t n = above; n < r && cells[runs[n].from] + width <= last; ++n) {
        const std::size_t a = find(n), b = find(r);
        root[std::max(a, b)] = std::min(a, b);
      }
    }
    for (std::size_t r = 0; r < runs.size(); ++r) root[r] = find(r);
    return root;
  }

  const ClusterWalls& cluster_walls_;
  std::vector<Vector2d> centers_;  ///< of the cells
  std::vector<Mask> sides_;        ///< index = wall
  Mask row_starts_;                ///< cells without one to their left
  Mask left_;
  std::vector<Gap> gaps_;  ///< by indices
};

}  // namespace

std::vector<Cluster> corridor_segments(const ClusterWalls& cluster_walls) {
  const double cell = cluster_walls.grid.frame.cell;
  const auto least = static_cast<std::size_t>(cluster_walls.config.min_part_m2 / (cell * cell));
  CorridorSegments stretches(cluster_walls);
  std::vector<Cluster> parts;
  while (parts.size() < most_parts) {
    const Part best = stretches.largest();
    if (best.cells < std::max<std::size_t>(least, 1)) break;
    stretches.take(best);
    std::vector<std::size_t> cells;
    cells.reserve(best.cells);
    for (const CellSpan& run : best.runs)
      for (std::size_t k = run.from; k < run.to; ++k) cells.push_back(cluster_walls.cluster.cells[k]);
    parts.push_back(cluster_of(cluster_walls.grid, std::move(cells)));
  }
  return parts;
}

}  // namespace plumbline::slam
