// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "sim/route/neighbour_ways.h"

namespace plumbline::scenarios {

/// A round from place 0 and back, no longer than longest_m by these ways, through some of the places: again and again
/// the one furthest from all chosen so far, where the round has room for it, so that far ends come first and what lies
/// on the way to them last. Places in the order of the walk, 0 left out (ties: the lower number).
[[nodiscard]] std::vector<std::size_t> tour(std::size_t places, const std::vector<sim::NeighbourWay>& ways,
                                            double longest_m);

}  // namespace plumbline::scenarios
