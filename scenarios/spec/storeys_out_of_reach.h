// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Why the stairs of the building do not help, a clause.
[[nodiscard]] std::string stairs_at_fault(const sim::MultiStoreyPlanner& space);

/// Storeys with something to walk on that no way leads to from a place, each with why.
[[nodiscard]] std::vector<std::string> storeys_out_of_reach(const sim::MultiStoreyPlanner& space,
                                                            const sim::FloorPoint& at);

}  // namespace plumbline::scenarios
