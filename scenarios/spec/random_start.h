// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"
#include "scenarios/spec/route_plan.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// Replaces a start and a route that are to be drawn by what the scenario's seed draws: a start from which other rooms
/// can be reached, and those that the route names if there is such a place, with any heading unless one is given; and
/// rooms of its storey, none twice in a row. In a doorway and at a stair, where the robot may not be able to turn
/// round, the heading is left to the first leg of its walk. Throws InputError where there is nothing to draw from.
void sample_start(const bim::Building& building, Scenario& scenario, const RouteMarks& marks);

}  // namespace plumbline::scenarios
