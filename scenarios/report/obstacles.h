// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bim/model/building.h"
#include "bim/plan/plan.h"

namespace plumbline::scenarios {

/// An obstacle on a storey that is no wall, as maps show it.
struct ReportObstacle {
  std::string id;
  int storey = -1;
  Polygon2 outline_W;   ///< from above, counter-clockwise
  bool filled = false;  ///< fills the outline, as a column does; else its convex hull, as of a table
};

/// A flight of stairs as maps show it, on the storeys at its foot and at its head.
struct ReportFlight {
  int from = -1, to = -1;                                             ///< storeys
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> risers_W;  ///< from the lowest up
};

/// The flights of a building's stairs.
[[nodiscard]] std::vector<ReportFlight> flights_of(const bim::Building& building);

/// Columns and furniture of a building and its plan, without what lies on the floor or hangs above the robot, and
/// without leaves and panes.
[[nodiscard]] std::vector<ReportObstacle> obstacles_of(const bim::Building& building, const bim::Plan& plan);

}  // namespace plumbline::scenarios
