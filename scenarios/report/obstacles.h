// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
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

/// Columns and furniture of a building and its plan, without what lies on the floor or hangs above the robot, and
/// without leaves and panes.
[[nodiscard]] std::vector<ReportObstacle> obstacles_of(const bim::Building& building, const bim::Plan& plan);

}  // namespace plumbline::scenarios
