// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline::bim {

/// Extents that a building has, by which a unit that a file does not give is told.
struct BuildingSizes {
  double largest_m = 400.0;
  double shortest_m = 5.0;  ///< of its longer side on the plan
  double lowest_m = 2.0;
  double highest_m = 100.0;

  [[nodiscard]] bool hold(const Eigen::Vector3d& sizes_m) const {
    return sizes_m.maxCoeff() <= largest_m && sizes_m.head<2>().maxCoeff() >= shortest_m && sizes_m.z() >= lowest_m &&
           sizes_m.z() <= highest_m;
  }
};

}  // namespace plumbline::bim
