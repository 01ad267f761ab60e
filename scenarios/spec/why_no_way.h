// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Why the robot does not get from one point to another, to be put behind "cannot be reached": closed doors, what
/// stops it on the floor, or the stairs.
[[nodiscard]] std::string why_no_way(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& from,
                                     const sim::FloorPoint& goal);

/// The same where it gets nowhere, to be put behind "there is nowhere to walk to": what stops it on the way to the
/// first of the other rooms of its storey, and what would help.
[[nodiscard]] std::string why_nowhere_to_walk(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& from);

}  // namespace plumbline::scenarios
