// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/straight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

constexpr std::size_t most_parts = 16;

/// What hangs together of the cells by 4-neighbours and is largest (ties: the one with the lowest cell); ascending.
std::vector<std::size_t> largest_component(const GridFrame& frame, const std::vector<std::size_t>& cells) {
  constexpr std::uint32_t outside = 0, unseen = 1;
  std::vector<std::uint32_t> label(frame.size(), outside);
  for (const std::size_t cell : cells) label[cell] = unseen;
  const auto width = static_cast<std::size_t>(frame.nx);
  std::uint32_t last = unseen, largest = unseen;
  std::size_t most = 0;
  std::vector<std::size_t> part;
  for (const std::size_t first : cells) {
    if (label[first] != unseen) continue;
    label[first] = ++last;
    part.assign(1, first);
    for (std::size_t k = 0; k < part.size(); ++k) {
      const std::size_t i = part[k] % width, j = part[k] / width;
      const auto visit = [&](std::size_t n) {
        if (label[n] != unseen) return;
        label[n] = last;
        part.push_back(n);
      };
      if (i > 0) visit(part[k] - 1);
      if (i + 1 < width) visit(part[k] + 1);
      if (j > 0) visit(part[k] - width);
      if (j + 1 < static_cast<std::size_t>(frame.ny)) visit(part[k] + width);
    }
    if (part.size() <= most) continue;
    most = part.size();
    largest = last;
  }
  std::vector<std::size_t> found;
  found.reserve(most);
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(found),
               [&](std::size_t cell) { return label[cell] == largest; });
  return found;
}

/// One bit a cell.
using Mask = std::vector<std::uint64_t>;

bool has(const Mask& mask, std::size_t k) { return (mask[k / 64] >> (k % 64) & 1U) != 0; }

/// Which of the cluster's cells lie on the free side of a wall.
Mask free_side(const Scene& scene, const FaceLine& wall) {
  const std::vector<std::size_t>& cells = scene.cluster.cells;
  Mask mask((cells.size() + 63) / 64, 0);
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (wall.distance(scene.grid.frame.center(cells[k])) > -scene.config.slack_m)
      mask[k / 64] |= std::uint64_t{1} << (k % 64);
  return mask;
}

/// Two opposed walls, by their places in the scene, and how many of the cells left lie between them.
struct Gap {
  std::size_t a = 0, b = 0, cells = 0;
};

/// By falling count; ties: lower places.
std::vector<Gap> gaps_of(const Scene& scene, const std::vector<Mask>& sides, const Mask& left) {
  const double opposed = -std::cos(scene.config.opposed_deg * std::numbers::pi / 180.0);
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < scene.walls.size(); ++i)
    for (std::size_t j = i + 1; j < scene.walls.size(); ++j) {
      if (scene.walls[i].m.dot(scene.walls[j].m) > opposed) continue;
      std::size_t count = 0;
      for (std::size_t w = 0; w < left.size(); ++w)
        count += static_cast<std::size_t>(std::popcount(sides[i][w] & sides[j][w] & left[w]));
      gaps.push_back({i, j, count});
    }
  std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.cells > b.cells; });
  return gaps;
}

/// The stretch of `between` that hangs together, or nothing where it is not mostly free.
std::vector<std::size_t> stretch(const Scene& scene, std::vector<std::size_t> between, const FaceLine& a,
                                 const FaceLine& b) {
  between = largest_component(scene.grid.frame, between);
  if (between.empty()) return between;
  double low = std::numeric_limits<double>::infinity(), high = -low, width = 0.0;
  for (const std::size_t k : between) {
    const Vector2d p = scene.grid.frame.center(k);
    low = std::min(low, a.along.dot(p));
    high = std::max(high, a.along.dot(p));
    width += a.distance(p) + b.distance(p);
  }
  width /= static_cast<double>(between.size());
  const double cell = scene.grid.frame.cell;
  const double free_m2 = cell * cell * static_cast<double>(between.size());
  const bool mostly_free = free_m2 >= scene.config.polygon_fill * width * (high - low + cell);
  if (width < scene.config.min_width_m || high - low < width || !mostly_free) between.clear();
  return between;
}

/// The largest stretch of what is left between two opposed walls (ties: the walls with more between them, then lower
/// places).
std::vector<std::size_t> largest_stretch(const Scene& scene, const std::vector<Mask>& sides, const Mask& left) {
  std::vector<std::size_t> best;
  for (const Gap& gap : gaps_of(scene, sides, left)) {
    if (gap.cells <= best.size()) break;
    std::vector<std::size_t> between;
    between.reserve(gap.cells);
    for (std::size_t k = 0; k < scene.cluster.cells.size(); ++k)
      if (has(left, k) && has(sides[gap.a], k) && has(sides[gap.b], k)) between.push_back(scene.cluster.cells[k]);
    std::vector<std::size_t> found = stretch(scene, std::move(between), scene.walls[gap.a], scene.walls[gap.b]);
    if (found.size() > best.size()) best = std::move(found);
  }
  return best;
}

}  // namespace

std::vector<Cluster> straight_parts(const Scene& scene) {
  const double cell = scene.grid.frame.cell;
  const auto least = static_cast<std::size_t>(scene.config.min_part_m2 / (cell * cell));
  std::vector<Mask> sides;
  for (const FaceLine& wall : scene.walls) sides.push_back(free_side(scene, wall));
  const std::vector<std::size_t>& cells = scene.cluster.cells;
  Mask left((cells.size() + 63) / 64, ~std::uint64_t{0});
  std::vector<Cluster> parts;
  while (parts.size() < most_parts) {
    std::vector<std::size_t> best = largest_stretch(scene, sides, left);
    if (best.size() < std::max<std::size_t>(least, 1)) break;
    auto taken = best.begin();
    for (std::size_t k = 0; k < cells.size() && taken != best.end(); ++k) {
      if (cells[k] != *taken) continue;
      left[k / 64] &= ~(std::uint64_t{1} << (k % 64));
      ++taken;
    }
    parts.push_back(cluster_of(scene.grid, std::move(best)));
  }
  return parts;
}

}  // namespace plumbline::slam
