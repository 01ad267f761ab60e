// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/route/route.h"

namespace plumbline::scenarios {

/// How a round is found where no rooms say where to go.
struct ExplorationConfig {
  double step_m = 1.0;       ///< least distance of the places looked at
  double most_places = 900;  ///< looked at; a larger world gets a larger step
  int goals = 6;             ///< places walked to before the way home
  double longest_m = 80.0;   ///< no further goal once the walk is this long
  double nearest_m = 2.0;    ///< a goal lies at least this far from where the walk has been
};

/// For floors on which that finds nothing.
[[nodiscard]] constexpr ExplorationConfig small_floor_exploration() {
  ExplorationConfig config;
  config.step_m = 0.25;
  config.nearest_m = 0.5;
  return config;
}

/// Box around the floor of a storey, or around its walls where there is none.
[[nodiscard]] Eigen::AlignedBox2d floor_box(const bim::Building& building, int storey);

/// Waypoints of a round from `start` and back through places within `bounds` (a box) where the robot can turn round,
/// each the one furthest from where the walk has been by then (ties: lowest, then leftmost); `start` alone where none
/// can be reached.
[[nodiscard]] std::vector<Eigen::Vector2d> exploration_route(const sim::ClearanceMap& space,
                                                             const Eigen::AlignedBox2d& bounds,
                                                             const Eigen::Vector2d& start,
                                                             const ExplorationConfig& config = {});

}  // namespace plumbline::scenarios
