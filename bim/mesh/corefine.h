// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/mesh/wall_cut.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// A solid with unjoined or unevenly turned triangles made into one closed solid, outward; nullopt when its surface
/// does not close. Closed shells that touch or overlap are united. Coordinates are put on the grid.
[[nodiscard]] std::optional<Solid> repaired(const Solid& solid, double grid_m = MeshConfig{}.weld_m);

/// True when triangles of a closed solid meet anywhere but in the edges and vertices that they share.
[[nodiscard]] bool runs_through_itself(const Solid& closed);

/// Body minus one closed cutter, by corefinement in 3D; nullopt when the two cannot be corefined (self-intersections,
/// non-manifold result). Both must be closed and outward. The order of vertices and triangles depends on what ran
/// before: canonicalise.
[[nodiscard]] std::optional<Solid> difference(const Solid& body, const Solid& cutter,
                                              double grid_m = MeshConfig{}.weld_m);

/// What two closed solids have in common, likewise.
[[nodiscard]] std::optional<Solid> intersection(const Solid& a, const Solid& b, double grid_m = MeshConfig{}.weld_m);

}  // namespace plumbline::bim
