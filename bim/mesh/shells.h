// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Parts of a mesh that share no vertex, in the order of their first vertices.
[[nodiscard]] std::vector<Solid> shells(const Solid& solid);

/// Whether all of a shell lies within another, closed one; it may touch it.
[[nodiscard]] bool encloses(const Solid& outer, const Solid& inner);

/// The same closed solid with its shells turned outward, but for hollows: shells that point inward, within one that
/// points outward, in a solid whose volume is positive.
[[nodiscard]] Solid shells_turned_outward(const Solid& solid);

/// A surface of whose triangles some are turned over against their neighbours, turned alike and outward; unchanged
/// where an edge is not shared by just two, or where they cannot be alike.
[[nodiscard]] Solid turned_alike(const Solid& solid);

/// Whether a mesh is several closed shells that each bound material and may overlap or touch, as the items of a body
/// do.
[[nodiscard]] bool shells_may_overlap(const Solid& solid, double grid_m);

}  // namespace plumbline::bim
