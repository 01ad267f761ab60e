// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "bim/geometry/grid_frame.h"
#include "bim/model/walked_floors.h"
#include "sim/route/obstacle_footprint.h"

namespace plumbline::sim {

/// Calls visit(cell) for every cell whose centre is inside a closed outline (even-odd), row by row.
void fill_cells(const GridFrame& grid, const std::vector<Segment2>& outline,
                const std::function<void(std::size_t)>& visit);

/// Whether a slab or a room says where the floor of a storey is.
[[nodiscard]] bool has_known_floor(const bim::Building& building, int storey, double ground_W,
                                   const RouteConfig& config);

/// True where the floor of a storey carries a robot, by cell. Without any slab on the storey its rooms do, and without
/// those the ground does, everywhere. Of a building without rooms, such as a mesh, only the floor with something
/// overhead counts, where there is such floor: inside is where there is a ceiling.
[[nodiscard]] std::vector<char> floor_cells(const bim::Building& building, int storey, double ground_W,
                                            const GridFrame& grid, const RouteConfig& config);

/// Height of the floor over the ground by cell, m, where raised floors are; empty where there are none. Cells of raised
/// floors become floor.
[[nodiscard]] std::vector<float> floor_heights(const bim::WalkedFloors& floors, const GridFrame& grid,
                                               const RouteConfig& config, std::vector<char>& floor);

/// The clearances of a storey with raised floors: of each cell for a robot at the height of its floor, where a step
/// that is too high is an edge.
[[nodiscard]] std::vector<double> clearances_over(const bim::Building& building, int storey,
                                                  const bim::WalkedFloors& floors, const GridFrame& grid,
                                                  const RouteConfig& config, const std::vector<char>& floor,
                                                  const std::vector<float>& heights);

/// Distance of every cell's centre to the nearest edge of a blockage or border of the floor, m; 0 inside a blockage
/// and off the floor. Distances are to the edges themselves, not to cells; which edge is nearest is handed on from
/// cell to cell, so that a clearance is never too small, and too large by less than a tenth of a cell [danielsson1980].
[[nodiscard]] std::vector<double> clearances(const GridFrame& grid, const std::vector<ObstacleFootprint>& footprints,
                                             const std::vector<char>& floor,
                                             const std::vector<Segment2>& more_edges = {});

}  // namespace plumbline::sim
