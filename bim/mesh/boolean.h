// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/mesh/exact_boolean.h"

namespace plumbline::bim {

/// A solid after booleans, and what could not be done.
struct BooleanResult {
  Solid solid;                      ///< not canonical
  std::vector<std::size_t> failed;  ///< indices of steps whose other solid does not close: they changed nothing
  bool closed = true;               ///< false: cut as a surface, since the body does not close or runs through itself
};

/// Takes all steps in their order: by corefinement, where that gives up in exact arithmetic from the beginning, and as
/// a surface where the body has no inside. Coordinates are put on the grid.
[[nodiscard]] BooleanResult boolean_steps(const Solid& body, std::span<const BooleanStep> steps, double grid_m);

}  // namespace plumbline::bim
