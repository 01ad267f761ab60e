// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Ids of the closed doors on the way from a to b, as it would be with every door open; none when there would be no
/// way even so. In the order of the building.
[[nodiscard]] std::vector<std::string> closed_doors_between(const bim::Building& building, const sim::FloorPoint& a,
                                                            const sim::FloorPoint& b);

/// What to do about closed doors, for an error message.
[[nodiscard]] std::string open_them(const std::vector<std::string>& doors);

}  // namespace plumbline::scenarios
