// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"
#include "scenarios/spec/scenario.h"
#include "sim/moving/dynamic_obstacles.h"

namespace plumbline::scenarios {

/// Lines the people of a scenario walk: straight between points, through the as-built free space between rooms.
/// Throws InputError at the entry of `people` that names no known room or cannot get from one room to the next.
[[nodiscard]] std::vector<sim::PersonConfig> place_people(const bim::Building& as_built, const Scenario& scenario,
                                                          const Tree& tree, int storey);

/// Leaves of the moving doors, shut in the middle of their walls. Throws InputError at the entry of `moving_doors` that
/// names no door, or one that is shut in the building.
[[nodiscard]] std::vector<sim::SwingDoorConfig> place_doors(const bim::Building& as_built, const Scenario& scenario,
                                                            const Tree& tree);

}  // namespace plumbline::scenarios
