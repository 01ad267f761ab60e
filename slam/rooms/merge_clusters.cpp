// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/merge_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

/// Cells of the first of two clusters that touch the second, by (first, second), first < second.
using Contacts = std::map<std::pair<int, int>, std::vector<std::size_t>>;

/// Cluster of each cell of the grid, or -1.
using Owners = std::vector<int>;

Owners owners_of(const FreeGrid& grid, std::span<const Cluster> clusters) {
  Owners owner(grid.frame.size(), -1);
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (const std::size_t cell : clusters[c].cells) owner[cell] = static_cast<int>(c);
  return owner;
}

Contacts contacts_of(const FreeGrid& grid, std::span<const Cluster> clusters, const Owners& owner) {
  const auto width = static_cast<std::size_t>(grid.frame.nx), height = static_cast<std::size_t>(grid.frame.ny);
  Contacts contacts;
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (const std::size_t cell : clusters[c].boundary) {
      const std::size_t i = cell % width, j = cell / width;
      std::array<int, 4> around = {-1, -1, -1, -1};
      if (i > 0) around[0] = owner[cell - 1];
      if (i + 1 < width) around[1] = owner[cell + 1];
      if (j > 0) around[2] = owner[cell - width];
      if (j + 1 < height) around[3] = owner[cell + width];
      std::sort(around.begin(), around.end());
      const auto last = std::unique(around.begin(), around.end());
      for (auto other = around.begin(); other != last; ++other)
        if (*other > static_cast<int>(c)) contacts[{static_cast<int>(c), *other}].push_back(cell);
    }
  return contacts;
}

/// Walls of one cluster that go on along the other, by their distance at p: the same plane, or another in its line.
std::vector<FaceLine> shared_walls(const ClusterWalls& first, const ClusterWalls& second, const Vector2d& p) {
  constexpr double same_line_m = 0.1;
  const double parallel = std::cos(first.config.opposed_deg * std::numbers::pi / 180.0);
  std::vector<FaceLine> shared;
  for (const FaceLine& wall : first.walls)
    if (std::any_of(second.walls.begin(), second.walls.end(), [&](const FaceLine& other) {
          return wall.m.dot(other.m) > parallel && std::abs(wall.distance(p) - other.distance(p)) < same_line_m;
        }))
      shared.push_back(wall);
  return shared;
}

/// Length across, along unit n, that the cells cover; they lie in a chain, so at most a diagonal apart.
double covered(const GridFrame& frame, const std::vector<std::size_t>& cells, const Vector2d& n) {
  const double bin_m = 1.5 * frame.cell;
  std::vector<int> bins;
  for (const std::size_t cell : cells) bins.push_back(static_cast<int>(std::floor(n.dot(frame.center(cell)) / bin_m)));
  std::sort(bins.begin(), bins.end());
  return bin_m * static_cast<double>(std::unique(bins.begin(), bins.end()) - bins.begin());
}

/// Share of the width between two opposed walls at p that lies in one of two clusters.
double open_share(const FreeGrid& grid, const Owners& owner, const std::array<int, 2>& pair, const FaceLine& a,
                  const FaceLine& b, const Vector2d& p) {
  const double from = -a.distance(p), to = b.distance(p), cell = grid.frame.cell;
  std::size_t free = 0, all = 0;
  for (double t = from + 0.5 * cell; t < to; t += cell, ++all)
    if (const auto at = grid.frame.find(p + t * a.m); at && (owner[*at] == pair[0] || owner[*at] == pair[1])) ++free;
  return all == 0 ? 0.0 : static_cast<double>(free) / static_cast<double>(all);
}

/// Length along two opposed walls over which the space between them is narrowed at p, as far as a cupboard may reach.
/// Where the watershed gave all of a passage to one cluster, p lies at its end.
double narrow_length(const FreeGrid& grid, const Owners& owner, const std::array<int, 2>& pair, const FaceLine& a,
                     const FaceLine& b, const Vector2d& p) {
  constexpr double wide_share = 0.85;
  constexpr int farthest_cells = 15, end_cells = 2;
  const auto narrow = [&](int k) {
    return std::abs(k) <= farthest_cells &&
           open_share(grid, owner, pair, a, b, p + k * grid.frame.cell * a.along) <= wide_share;
  };
  for (int k = 0; k <= end_cells; ++k)
    for (const int at : {k, -k}) {
      if (!narrow(at)) continue;
      int from = at, to = at;
      while (narrow(from - 1)) --from;
      while (narrow(to + 1)) ++to;
      return grid.frame.cell * (to - from + 1);
    }
  return 0.0;
}

bool are_one(const ClusterWalls& first, const ClusterWalls& second, const std::vector<std::size_t>& contact,
             const Owners& owner, const std::array<int, 2>& pair) {
  constexpr double thickest_wall_m = 0.5;
  const RoomConfig& config = first.config;
  Vector2d p = Vector2d::Zero();
  for (const std::size_t cell : contact) p += first.grid.frame.center(cell);
  p /= static_cast<double>(contact.size());
  const std::vector<FaceLine> walls = shared_walls(first, second, p);
  const double opposed = -std::cos(config.opposed_deg * std::numbers::pi / 180.0);
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const FaceLine &a = walls[i], &b = walls[j];
      if (a.m.dot(b.m) > opposed || a.distance(p) <= 0.0 || b.distance(p) <= 0.0) continue;
      const double width = a.distance(p) + b.distance(p);
      if (width < config.min_width_m) continue;
      const double share = covered(first.grid.frame, contact, a.m) / width;
      if (share >= config.joined_share) return true;
      if (share >= config.passed_share && narrow_length(first.grid, owner, pair, a, b, p) > thickest_wall_m)
        return true;
    }
  return false;
}

/// Clusters of one root made one, each at the position of its first, without those of fewer than `least`.
std::vector<Cluster> clusters_by_root(const FreeGrid& grid, std::span<const Cluster> clusters,
                                      const std::vector<std::size_t>& root, std::ptrdiff_t least) {
  std::vector<Cluster> joined;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const std::ptrdiff_t members = std::count(root.begin(), root.end(), c);
    if (root[c] != c || members < least) continue;
    if (members == 1) {
      joined.push_back(clusters[c]);
      continue;
    }
    std::vector<std::size_t> cells, merged;
    double clearance_m = 0.0;
    for (std::size_t k = c; k < clusters.size(); ++k) {
      if (root[k] != c) continue;
      merged.clear();
      std::merge(cells.begin(), cells.end(), clusters[k].cells.begin(), clusters[k].cells.end(),
                 std::back_inserter(merged));
      cells.swap(merged);
      clearance_m = std::max(clearance_m, clusters[k].clearance_m);
    }
    joined.push_back(cluster_of(grid, std::move(cells)));
    joined.back().clearance_m = clearance_m;
  }
  return joined;
}

}  // namespace

std::vector<Cluster> merge_clusters(const FreeGrid& grid, std::span<const Cluster> clusters,
                                    std::span<const FaceLine> faces, const RoomConfig& config) {
  std::vector<ClusterWalls> walls_of_cluster;
  for (const Cluster& cluster : clusters) walls_of_cluster.push_back(make_cluster_walls(grid, cluster, faces, config));
  std::vector<std::size_t> root(clusters.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const Owners owner = owners_of(grid, clusters);
  for (const auto& [pair, contact] : contacts_of(grid, clusters, owner)) {
    const std::size_t a = root[static_cast<std::size_t>(pair.first)], b = root[static_cast<std::size_t>(pair.second)];
    if (a == b ||
        !are_one(walls_of_cluster[static_cast<std::size_t>(pair.first)],
                 walls_of_cluster[static_cast<std::size_t>(pair.second)], contact, owner, {pair.first, pair.second}))
      continue;
    std::replace(root.begin(), root.end(), std::max(a, b), std::min(a, b));
  }
  return clusters_by_root(grid, clusters, root, 1);
}

std::vector<Cluster> merge_wide(const FreeGrid& grid, std::span<const Cluster> clusters, double wider_than_m) {
  std::vector<std::size_t> root(clusters.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  for (const auto& [pair, contact] : contacts_of(grid, clusters, owners_of(grid, clusters))) {
    if (static_cast<double>(contact.size()) * grid.frame.cell <= wider_than_m) continue;
    const std::size_t a = root[static_cast<std::size_t>(pair.first)], b = root[static_cast<std::size_t>(pair.second)];
    std::replace(root.begin(), root.end(), std::max(a, b), std::min(a, b));
  }
  return clusters_by_root(grid, clusters, root, 2);
}

}  // namespace plumbline::slam
