// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/load/load.h"

namespace plumbline::scenarios {

/// A page on where a robot can walk in a building as built: for each storey with rooms the floor that it reaches from
/// where it would start, the walk it would take by default, each room by whether it is on the walk, in reach or out of
/// reach, and what stops the robot on the way to those. `name` is the title.
[[nodiscard]] std::string walk_page(const bim::PlannedAndBuilt& site, const std::string& name);

}  // namespace plumbline::scenarios
