// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "sim/route/grid_search.h"
#include "sim/route/route.h"

namespace plumbline::sim {

namespace {

constexpr std::int64_t unit_cost = 100;  // of a tenth of a cell at comfortable clearance
/// Admissible A* heuristic: the cost of the path over open ground.
std::int64_t open_ground_cost(const GridFrame& grid, std::size_t from, std::size_t to) {
  const auto [from_x, from_y] = grid.column_and_row(from);
  const auto [to_x, to_y] = grid.column_and_row(to);
  const std::int64_t dx = std::abs(from_x - to_x), dy = std::abs(from_y - to_y);
  return unit_cost * (straight_step * (std::max(dx, dy) - std::min(dx, dy)) + diagonal_step * std::min(dx, dy));
}

bool crosses_step(const ClearanceMap& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const int count = 1 + static_cast<int>(2.0 * (b - a).norm() / space.grid().cell);
  double before = space.height(a);
  for (int i = 1; i <= count; ++i) {
    const double here = space.height(a + (b - a) * (static_cast<double>(i) / count));
    if (std::abs(here - before) > space.config().flat_m) return true;
    before = here;
  }
  return false;
}

}  // namespace

std::vector<std::size_t> ClearanceMap::cells_in_reach(std::size_t from, std::vector<char>& seen) const {
  std::vector<std::size_t> cells = {from};
  seen[from] = 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [column, row] = grid_.column_and_row(cells[i]);
    for (const GridStep& step : grid_steps) {
      const int x = column + step.dx, y = row + step.dy;
      if (!grid_.holds(x, y)) continue;
      const std::size_t next = grid_.index(x, y);
      if (seen[next] != 0 || !passable(next) || !joined(cells[i], next)) continue;
      seen[next] = 1;
      cells.push_back(next);
    }
  }
  return cells;
}

std::int64_t ClearanceMap::step_cost(std::size_t cell) const {
  const double crowded = (config_.comfort_m - clearance_[cell]) / (config_.comfort_m - config_.radius_m);
  return unit_cost +
         static_cast<std::int64_t>(static_cast<double>(unit_cost) * config_.crowding * std::max(0.0, crowded));
}

const std::vector<int>& ClearanceMap::regions() const {
  if (!regions_.empty()) return regions_;
  regions_.assign(grid_.size(), -1);
  std::vector<char> seen(grid_.size(), 0);
  int count = 0;
  for (std::size_t cell = 0; cell < grid_.size(); ++cell) {
    if (seen[cell] != 0 || !passable(cell)) continue;
    for (const std::size_t other : cells_in_reach(cell, seen)) regions_[other] = count;
    ++count;
  }
  return regions_;
}

int ClearanceMap::region(const Eigen::Vector2d& p) const {
  const auto cell = grid_.find(p);
  return cell ? regions()[*cell] : -1;
}

/// A*: integer costs; of equal costs the cell with the lowest index goes first, and the first path found stays.
std::vector<std::size_t> ClearanceMap::search(std::size_t from, std::size_t to) const {
  if (regions()[from] != regions()[to]) return {};
  constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
  using Entry = std::pair<std::int64_t, std::size_t>;
  search_.cost.resize(grid_.size(), unknown);
  search_.before.resize(grid_.size());
  search_.done.resize(grid_.size(), 0);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](std::size_t cell, std::size_t before, std::int64_t cost) {
    if (cost >= search_.cost[cell]) return;
    if (search_.cost[cell] == unknown) search_.touched.push_back(cell);
    search_.cost[cell] = cost;
    search_.before[cell] = static_cast<std::uint32_t>(before);
    open.emplace(cost + open_ground_cost(grid_, cell, to), cell);
  };
  reach(from, from, 0);
  while (search_.done[to] == 0) {
    const std::size_t cell = open.top().second;
    open.pop();
    if (search_.done[cell] != 0) continue;
    search_.done[cell] = 1;
    const auto [column, row] = grid_.column_and_row(cell);
    for (const GridStep& step : grid_steps) {
      const int x = column + step.dx, y = row + step.dy;
      if (!grid_.holds(x, y) || !passable(grid_.index(x, y))) continue;
      const std::size_t next = grid_.index(x, y);
      if (!joined(cell, next)) continue;
      const std::int64_t detour = is_step(cell, next) ? std::llround(config_.step_detour_m / grid_.cell) : 0;
      reach(next, cell, search_.cost[cell] + (step.length + straight_step * detour) * step_cost(next));
    }
  }
  std::vector<std::size_t> cells = {to};
  while (cells.back() != from) cells.push_back(search_.before[cells.back()]);
  std::reverse(cells.begin(), cells.end());
  for (const std::size_t cell : search_.touched) {
    search_.cost[cell] = unknown;
    search_.done[cell] = 0;
  }
  search_.touched.clear();
  return cells;
}

bool ClearanceMap::clear_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double clearance_m) const {
  const int count = 1 + static_cast<int>(2.0 * (b - a).norm() / grid_.cell);
  for (int i = 0; i <= count; ++i)
    if (clearance(a + (b - a) * (static_cast<double>(i) / count)) < clearance_m) return false;
  return true;
}

/// Leaves out points as long as the straight line keeps the clearance that the path around them had, or enough,
/// and crosses no step: the robot has to line up with one.
std::vector<Eigen::Vector2d> ClearanceMap::shortened(const std::vector<Eigen::Vector2d>& points) const {
  const double slack = 0.25 * config_.cell_m;  // a line off the cells' centres is a little nearer to a wall
  std::vector<Eigen::Vector2d> kept = {points.front()};
  std::size_t from = 0;
  while (from + 1 < points.size()) {
    double narrowest = std::min(clearance(points[from]), clearance(points[from + 1]));
    std::size_t to = from + 1;
    while (to + 1 < points.size()) {
      narrowest = std::min(narrowest, clearance(points[to + 1]));
      const double wanted = std::max(clearance_min(), std::min(narrowest - slack, config_.shortcut_m));
      if (!clear_line(points[from], points[to + 1], wanted) || crosses_step(*this, points[from], points[to + 1])) break;
      ++to;
    }
    kept.push_back(points[to]);
    from = to;
  }
  return kept;
}

std::vector<Eigen::Vector2d> ClearanceMap::path(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  std::vector<Eigen::Vector2d> points;
  for (const PathPart& part : parts(a, b))
    points.insert(points.end(), part.points.begin() + (points.empty() ? 0 : 1), part.points.end());
  return points;
}

std::vector<PathPart> ClearanceMap::parts(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  constexpr int most_steps = 40;
  std::vector<PathPart> parts;
  if (!add_parts(a, b, most_steps, parts)) parts.clear();
  return parts;
}

/// Up to the first step, over it, and on from there.
bool ClearanceMap::add_parts(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int steps_left,
                             std::vector<PathPart>& parts) const {
  const auto from = grid_.find(a);
  const auto to = grid_.find(b);
  if (!from || !to || !passable(*from) || !passable(*to)) return false;
  const std::vector<std::size_t> cells = search(*from, *to);
  if (cells.empty()) return false;
  std::size_t end = 1;
  while (end < cells.size() && !is_step(cells[end - 1], cells[end])) ++end;
  if (end >= cells.size()) {
    std::vector<Eigen::Vector2d> points = {a};
    for (std::size_t i = 1; i + 1 < cells.size(); ++i) points.push_back(grid_.center(cells[i]));
    points.push_back(b);
    parts.push_back({shortened(points), height(b), false});
    return true;
  }
  const auto over = over_step(cells[end - 1], cells[end]);
  if (!over || steps_left == 0) return false;
  // To where the robot lines up, which need not lie on the path; no step leads there.
  if ((over->first - a).norm() > grid_.cell && !add_parts(a, over->first, 0, parts)) return false;
  const Eigen::Vector2d foot = parts.empty() ? a : parts.back().points.back();
  parts.push_back({{foot, over->second}, height(over->second), true});
  return add_parts(over->second, b, steps_left - 1, parts);
}

std::vector<Eigen::Vector2d> ClearanceMap::reachable(const Eigen::Vector2d& from,
                                                     const std::vector<Eigen::Vector2d>& points) const {
  const int here = region(from);
  std::vector<Eigen::Vector2d> found;
  for (const Eigen::Vector2d& point : points)
    if (here >= 0 && region(point) == here) found.push_back(point);
  return found;
}

}  // namespace plumbline::sim
