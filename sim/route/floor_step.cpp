// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "sim/route/route.h"

namespace plumbline::sim {

double ClearanceMap::height(const Eigen::Vector2d& p) const {
  const auto cell = grid_.find(p);
  return cell ? cell_height(*cell) : 0.0;
}

bool ClearanceMap::is_step(std::size_t cell, std::size_t next) const {
  return !heights_.empty() && std::abs(cell_height(cell) - cell_height(next)) > config_.flat_m;
}

bool ClearanceMap::joined(std::size_t cell, std::size_t next) const {
  if (!is_step(cell, next)) return true;
  const auto [known, is_new] = joined_.try_emplace({std::min(cell, next), std::max(cell, next)}, false);
  if (is_new) known->second = over_step(cell, next).has_value();
  return known->second;
}

/// Across the edge between the two floors, whose direction the heights around it tell.
std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> ClearanceMap::over_step(std::size_t cell,
                                                                                   std::size_t next) const {
  constexpr int window = 5;         // cells around the edge
  constexpr double apart_m = 0.05;  // of the tries
  const double low = std::min(cell_height(cell), cell_height(next)),
               high = std::max(cell_height(cell), cell_height(next));
  if (high - low > config_.climb_m + 1e-3) return std::nullopt;
  const Eigen::Vector2d edge = 0.5 * (grid_.center(cell) + grid_.center(next));
  Eigen::Vector2d up = Eigen::Vector2d::Zero();
  const auto [column, row] = grid_.column_and_row(std::min(cell, next));  // whichever way it is crossed
  for (int dy = -window; dy <= window; ++dy)
    for (int dx = -window; dx <= window; ++dx) {
      if (!grid_.holds(column + dx, row + dy)) continue;
      const std::size_t other = grid_.index(column + dx, row + dy);
      if (!has_floor(other)) continue;
      const double sign = cell_height(other) >= high - config_.flat_m ? 1.0 : -1.0;
      up += sign * (grid_.center(other) - edge);
    }
  if (up.norm() < 1e-9) return std::nullopt;
  up.normalize();
  const auto place = [&](const Eigen::Vector2d& away, double wanted) -> std::optional<Eigen::Vector2d> {
    for (double s = config_.step_before_m; s >= config_.step_before_min_m - 1e-9; s -= apart_m) {
      const Eigen::Vector2d p = edge + s * away;
      if (std::abs(height(p) - wanted) <= config_.flat_m && clear_line(edge, p, clearance_min())) return p;
    }
    return std::nullopt;
  };
  const auto foot = place(-up, low), head = place(up, high);
  if (!foot || !head) return std::nullopt;
  if (cell_height(cell) <= cell_height(next)) return std::pair(*foot, *head);
  return std::pair(*head, *foot);
}

}  // namespace plumbline::sim
