// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/route/route.h"

namespace plumbline::sim {

/// The way between two places that no third place is nearer to.
struct NeighbourWay {
  std::size_t a = 0, b = 0;  ///< a < b
  double length_m = 0.0;     ///< over the grid, up to a tenth longer than the way the robot walks
};

/// Ways between neighbours among places on a floor, by (a, b). One search over the whole floor finds them all, however
/// many there are. A place off the walkable floor has no ways.
[[nodiscard]] std::vector<NeighbourWay> neighbour_ways(const ClearanceMap& space,
                                                       const std::vector<Eigen::Vector2d>& places);

}  // namespace plumbline::sim
