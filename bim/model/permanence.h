// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// How surely an element still stands where the plan has it, surest first. Walls, slabs, columns, stairs and openings
/// are always structure.
enum class Permanence {
  structure,  ///< what was built: also railings, beams, curtain walls, door leaves and panes
  fixed,      ///< installations: sanitary and other terminals, ducts, lifts
  furniture,  ///< planned, and may have been moved, swapped or taken away
  clutter     ///< not planned
};
[[nodiscard]] constexpr std::array<std::string_view, 4> names_of(Permanence) {
  return {"structure", "fixed", "furniture", "clutter"};
}

[[nodiscard]] Permanence permanence_of(const Obstacle& obstacle);
/// Furniture or clutter.
[[nodiscard]] bool may_have_moved(const Obstacle& obstacle);
/// Nothing of this id stands in the building as built: it was taken away, or another piece stands instead.
[[nodiscard]] bool is_gone(const Obstacle& planned, const Building& as_built);

}  // namespace plumbline::bim
