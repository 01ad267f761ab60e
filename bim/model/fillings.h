// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/model/building.h"
#include "bim/model/building_options.h"

namespace plumbline::bim {

/// Leaves and panes, in the middle of their walls.
struct FillingConfig {
  double leaf_m = 0.04;                 ///< thickness of a closed door leaf
  double pane_m = 0.024;                ///< of a window pane: 4 mm glass, 16 mm gap, 4 mm glass
  std::string pane_material = "glass";  ///< of windows that name none
};

/// Derived obstacles that add_fillings makes; they are no part of a building's content.
[[nodiscard]] bool is_filling(const Obstacle& obstacle);

/// Sets the door leaves and removes the planned furniture, by the scenario's options. Unplanned obstacles stay.
void apply_options(Building& building, const BuildingOptions& options);
/// Adds a thin solid for each closed door leaf ("<opening>/leaf") and each window pane ("<opening>/pane").
void add_fillings(Building& building, const FillingConfig& config = {});

}  // namespace plumbline::bim
