// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::scenarios {

/// What stands on a storey in a robot's way and is no wall, as maps show it.
struct ReportThing {
  std::string id;
  int storey = -1;
  Polygon2 outline_W;   ///< from above, counter-clockwise
  bool filled = false;  ///< fills the outline, as a column does; else its convex hull, as of a table
};

/// Columns and furniture, without what lies on the floor or hangs above the robot, and without leaves and panes.
[[nodiscard]] std::vector<ReportThing> things_of(const bim::Building& building);

}  // namespace plumbline::scenarios
