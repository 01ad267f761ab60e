// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/route/multi_storey_planner.h"
#include "sim/route/waypoint.h"

namespace plumbline::scenarios {

/// Whether a walk gets well inside the room with this index, or as far as the robot fits into it: a walk along a common
/// edge is in neither room.
[[nodiscard]] bool enters_room(const sim::MultiStoreyPlanner& space, const std::vector<sim::Waypoint>& way, int room);

}  // namespace plumbline::scenarios
