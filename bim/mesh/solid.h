// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// Signed volume of a closed solid, m^3, positive when its triangles are counter-clockwise seen from outside.
[[nodiscard]] double volume(const Solid& solid);
/// True when there are triangles and every edge is shared by exactly two of them, in opposite directions.
[[nodiscard]] bool is_closed(const Solid& solid);

/// Vertices on a grid, sorted; each triangle starts at its lowest vertex; triangles sorted. Vertices that share a
/// position stay apart, so a closed solid stays closed.
[[nodiscard]] Solid canonical(const Solid& solid, double grid_m);
/// Joins vertices that share a grid point and drops triangles that collapse.
[[nodiscard]] Solid welded(const Solid& solid, double grid_m);
/// Removes triangles of no height, to within the grid, by flipping the diagonal they share with the neighbour at
/// their longest side. Others keep their place.
[[nodiscard]] Solid without_slivers(Solid solid, double grid_m);
/// The same solid with all triangles turned over when its volume is negative.
[[nodiscard]] Solid turned_outward(const Solid& solid);
/// A closed solid with all faces moved outward, m; where more than three planes meet in a vertex, as nearly as it can
/// move. Corners sharper than 1 in 10 move less.
[[nodiscard]] Solid widened(const Solid& closed, double by_m);

}  // namespace plumbline::bim
