// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/straight.h"

#include <algorithm>
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
  std::vector<std::uint8_t> left(frame.size(), 0);
  for (const std::size_t cell : cells) left[cell] = 1;
  const auto width = static_cast<std::size_t>(frame.nx);
  std::vector<std::size_t> largest;
  for (const std::size_t first : cells) {
    if (left[first] == 0) continue;
    std::vector<std::size_t> part = {first};
    left[first] = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const std::size_t i = part[k] % width, j = part[k] / width;
      const auto visit = [&](std::size_t n) {
        if (left[n] == 0) return;
        left[n] = 0;
        part.push_back(n);
      };
      if (i > 0) visit(part[k] - 1);
      if (i + 1 < width) visit(part[k] + 1);
      if (j > 0) visit(part[k] - width);
      if (j + 1 < static_cast<std::size_t>(frame.ny)) visit(part[k] + width);
    }
    if (part.size() > largest.size()) largest = std::move(part);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

/// The stretch of the cells between two opposed walls, or nothing where it is not mostly free.
std::vector<std::size_t> stretch(const Scene& scene, const std::vector<std::size_t>& cells, const FaceLine& a,
                                 const FaceLine& b) {
  std::vector<std::size_t> between;
  for (const std::size_t k : cells) {
    const Vector2d p = scene.grid.frame.center(k);
    if (a.distance(p) > -scene.config.slack_m && b.distance(p) > -scene.config.slack_m) between.push_back(k);
  }
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

}  // namespace

std::vector<Cluster> straight_parts(const Scene& scene) {
  const double opposed = -std::cos(scene.config.opposed_deg * std::numbers::pi / 180.0);
  const double cell = scene.grid.frame.cell;
  const auto least = static_cast<std::size_t>(scene.config.min_part_m2 / (cell * cell));
  std::vector<std::size_t> left = scene.cluster.cells;
  std::vector<Cluster> parts;
  while (parts.size() < most_parts) {
    std::vector<std::size_t> best;
    for (std::size_t i = 0; i < scene.walls.size(); ++i)
      for (std::size_t j = i + 1; j < scene.walls.size(); ++j) {
        if (scene.walls[i].m.dot(scene.walls[j].m) > opposed) continue;
        std::vector<std::size_t> found = stretch(scene, left, scene.walls[i], scene.walls[j]);
        if (found.size() > best.size()) best = std::move(found);
      }
    if (best.size() < std::max<std::size_t>(least, 1)) break;
    std::vector<std::size_t> rest;
    std::set_difference(left.begin(), left.end(), best.begin(), best.end(), std::back_inserter(rest));
    left = std::move(rest);
    parts.push_back(cluster_of(scene.grid, std::move(best)));
  }
  return parts;
}

}  // namespace plumbline::slam
