// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/walks.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>
#include <tuple>

#include "scenarios/host/parallel.h"

namespace plumbline::scenarios {

namespace {

/// Neighbours in the cells of a map.
using Graph = std::vector<std::vector<std::pair<std::size_t, double>>>;

Graph graph_of(const LocalizabilityMapInput& input) {
  Graph graph;
  for (const Floor& floor : input.floors) {
    const std::size_t first = graph.size();
    graph.resize(first + floor.cells_W.size());
    for (const FloorLink& link : floor.links) {
      graph[first + link.a].emplace_back(first + link.b, link.length_m);
      graph[first + link.b].emplace_back(first + link.a, link.length_m);
    }
  }
  for (auto& neighbours : graph) std::sort(neighbours.begin(), neighbours.end());
  return graph;
}

/// Log-likelihood ratios of every scan against its image under every isometry, made where asked for. Whichever thread
/// makes one, it is the same.
class Ratios {
 public:
  Ratios(const WalkInput& walks, const LocalizabilityMap& map) : walks_(walks), map_(map) {
    for (std::size_t g = 0; g < map.isometries.size(); ++g) {
      auto& row = rows_.emplace_back(std::make_unique<std::atomic<float>[]>(map.cells.size()));
      for (std::size_t i = 0; i < map.cells.size(); ++i) row[i] = unknown;
    }
  }

  [[nodiscard]] double at(std::size_t isometry, std::size_t cell) const {
    std::atomic<float>& kept = rows_[isometry][cell];
    float value = kept;
    if (value != unknown) return static_cast<double>(value);
    const ReferenceScan& scan = walks_.scans[cell];
    const Pose X = map_.isometries[isometry] * scan.place.pose();
    const SensorPose alias{X.t, X.yaw()};
    value = walks_.finder.clearly_different(scan, alias) ? out : static_cast<float>(walks_.finder.llr(scan, alias));
    kept = value;
    return static_cast<double>(value);
  }

  /// How many were asked for, each counted once.
  [[nodiscard]] std::uint64_t made() const {
    std::uint64_t count = 0;
    for (const auto& row : rows_)
      for (std::size_t i = 0; i < map_.cells.size(); ++i) count += row[i] == unknown ? 0U : 1U;
    return count;
  }

 private:
  static constexpr float unknown = std::numeric_limits<float>::max();
  static constexpr float out = 1e6F;  ///< surely more than drop_llr
  const WalkInput& walks_;
  const LocalizabilityMap& map_;
  std::vector<std::unique_ptr<std::atomic<float>[]>> rows_;
};

/// Shortest paths from one cell, with the evidence of the scans on them against its aliases.
class Walker {
 public:
  Walker(const Graph& graph, const Ratios& ratios, const LocalizabilityMap& map)
      : graph_(graph), ratios_(ratios), map_(map) {}

  void answer(std::size_t start, MapCell& cell, bool compass_only) const {
    const std::vector<bool> turned = turns(cell);
    const auto straight = static_cast<int>(std::count(turned.begin(), turned.end(), false));
    cell.compass.aliases = straight;
    CellAnswer unknown{static_cast<int>(turned.size()), {}};
    walk(start, cell.aliases, [&](const std::vector<double>& against, double way) {
      bool all = true, all_straight = true;
      for (std::size_t i = 0; i < against.size(); ++i) {
        if (against[i] > localizability_constants.drop_llr) continue;
        all = false;
        all_straight = all_straight && turned[i];
      }
      if (all && !unknown.walk_m) unknown.walk_m = way;
      if (all_straight && !cell.compass.walk_m) cell.compass.walk_m = way;
      return all;
    });
    if (!compass_only) cell.unknown = unknown;
  }

 private:
  /// Which aliases a compass rules out.
  [[nodiscard]] std::vector<bool> turns(const MapCell& cell) const {
    std::vector<bool> turned;
    for (const CellAlias& alias : cell.aliases)
      turned.push_back(std::abs(map_.isometries[alias.isometry].yaw()) >
                       localizability_constants.known_yaw_deg * rad_per_deg);
    return turned;
  }

  /// Visits cells by their way from the start (ties: lower index) until `done(against, way)`.
  template <class Done>
  void walk(std::size_t start, const std::vector<CellAlias>& aliases, const Done& done) const {
    if (aliases.empty()) {
      (void)done({}, 0.0);
      return;
    }
    using Node = std::tuple<double, std::size_t, std::size_t>;  // way, cell, cell before
    std::priority_queue<Node, std::vector<Node>, std::greater<>> open;
    std::vector<std::vector<double>> against(graph_.size());
    open.emplace(0.0, start, start);
    while (!open.empty()) {
      const auto [way, cell, before] = open.top();
      open.pop();
      if (!against[cell].empty()) continue;
      std::vector<double> sum = cell == start ? std::vector<double>(aliases.size(), 0.0) : against[before];
      for (std::size_t i = 0; i < aliases.size(); ++i)
        if (sum[i] <= localizability_constants.drop_llr) sum[i] += ratios_.at(aliases[i].isometry, cell);
      if (done(sum, way)) return;
      against[cell] = std::move(sum);
      for (const auto& [next, length] : graph_[cell])
        if (against[next].empty()) open.emplace(way + length, next, cell);
    }
  }

  const Graph& graph_;
  const Ratios& ratios_;
  const LocalizabilityMap& map_;
};

}  // namespace

std::uint64_t answer_by_walks(const WalkInput& walks, LocalizabilityMap& map) {
  const Graph graph = graph_of(walks.input);
  const Ratios ratios(walks, map);
  const Walker walker(graph, ratios, map);
  for_each_index(map.cells.size(), walks.input.threads,
                 [&](std::size_t i) { walker.answer(i, map.cells[i], walks.input.compass_only); });
  return ratios.made();
}

}  // namespace plumbline::scenarios
