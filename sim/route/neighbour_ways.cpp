// SPDX-License-Identifier: Apache-2.0
#include "sim/route/neighbour_ways.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "sim/route/grid_search.h"

namespace plumbline::sim {

namespace {

constexpr std::int32_t nobody = -1;

/// Every cell with the place that is nearest by cost, and the length of the way to it in tenths of a cell.
class Territories {
 public:
  Territories(const ClearanceMap& space, const std::vector<Eigen::Vector2d>& places)
      : space_(space),
        cost_(space.grid().size(), std::numeric_limits<std::int32_t>::max()),
        length_(space.grid().size(), 0),
        owner_(space.grid().size(), nobody) {
    BucketQueue open(diagonal_step * widest_cost());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto cell = space.grid().find(places[i]);
      if (!cell || !space.passable(*cell) || cost_[*cell] == 0) continue;
      cost_[*cell] = 0;
      owner_[*cell] = static_cast<std::int32_t>(i);
      open.push(0, *cell);
    }
    while (!open.empty()) {
      const auto [cost, cell] = open.pop();
      if (cost == cost_[cell]) spread(cell, open);
    }
  }

  [[nodiscard]] std::vector<NeighbourWay> ways() const {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> shortest;
    for (std::size_t cell = 0; cell < owner_.size(); ++cell)
      each_neighbour(cell, [&](std::size_t next, std::int64_t step) {
        const auto pair = std::minmax(owner_[cell], owner_[next]);
        if (next < cell || pair.first == nobody || pair.first == pair.second) return;
        const std::int32_t length = length_[cell] + length_[next] + static_cast<std::int32_t>(step);
        const auto [it, is_new] = shortest.try_emplace({pair.first, pair.second}, length);
        if (!is_new) it->second = std::min(it->second, length);
      });
    std::vector<NeighbourWay> ways;
    for (const auto& [pair, length] : shortest)
      ways.push_back({static_cast<std::size_t>(pair.first), static_cast<std::size_t>(pair.second),
                      0.1 * space_.grid().cell * length});
    return ways;
  }

 private:
  /// Of a tenth of a cell where the robot just fits.
  [[nodiscard]] std::int64_t widest_cost() const {
    std::int64_t most = 1;
    for (std::size_t cell = 0; cell < space_.grid().size(); ++cell)
      if (space_.passable(cell)) most = std::max(most, space_.step_cost(cell));
    return most;
  }

  template <class Visit>
  void each_neighbour(std::size_t cell, Visit&& visit) const {
    const auto [column, row] = space_.grid().column_and_row(cell);
    for (const GridStep& step : grid_steps) {
      const int x = column + step.dx, y = row + step.dy;
      if (space_.grid().holds(x, y)) visit(space_.grid().index(x, y), step.length);
    }
  }

  void spread(std::size_t cell, BucketQueue& open) {
    each_neighbour(cell, [&](std::size_t next, std::int64_t step) {
      if (!space_.passable(next) || !space_.joined(cell, next)) return;
      const std::int64_t cost = cost_[cell] + step * space_.step_cost(next);
      if (cost >= cost_[next]) return;
      cost_[next] = static_cast<std::int32_t>(cost);
      length_[next] = length_[cell] + static_cast<std::int32_t>(step);
      owner_[next] = owner_[cell];
      open.push(cost, next);
    });
  }

  const ClearanceMap& space_;
  std::vector<std::int32_t> cost_;
  std::vector<std::int32_t> length_;
  std::vector<std::int32_t> owner_;
};

}  // namespace

std::vector<NeighbourWay> neighbour_ways(const ClearanceMap& space, const std::vector<Eigen::Vector2d>& places) {
  return Territories(space, places).ways();
}

}  // namespace plumbline::sim
