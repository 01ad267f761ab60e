// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::scenarios {

/// Size of the plan that costs are measured on, m.
struct LatticeConfig {
  double cell_x_m = 6.0;
  double cell_y_m = 4.0;
  double thickness_m = 0.2;
};

/// Text of a plan of `walls` walls that stand between the cells of a nearly square lattice, each with a door and a
/// window, a room in every cell of which all four walls are there.
[[nodiscard]] std::string lattice_plan(int walls, const LatticeConfig& config = {});

}  // namespace plumbline::scenarios
