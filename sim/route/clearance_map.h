// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/grid_frame.h"
#include "sim/route/obstacle_footprint.h"

namespace plumbline::sim {

/// True where the floor of a storey carries a robot, by cell. Without any slab on the storey its rooms do.
[[nodiscard]] std::vector<char> floor_cells(const bim::Building& building, int storey, const GridFrame& grid,
                                            const RouteConfig& config);

/// Distance of every cell's centre to the nearest edge of a blockage or border of the floor, m; 0 inside a blockage
/// and off the floor. Distances are to the edges themselves, not to cells; which edge is nearest is handed on from
/// cell to cell, so that a clearance is never too small, and too large by less than a tenth of a cell [danielsson1980].
[[nodiscard]] std::vector<double> clearances(const GridFrame& grid, const std::vector<ObstacleFootprint>& footprints,
                                             const std::vector<char>& floor);

}  // namespace plumbline::sim
