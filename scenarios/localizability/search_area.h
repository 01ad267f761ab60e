// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::scenarios {

/// Where candidates are searched for: the floor of one storey.
struct SearchArea {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  double sensor_z_W = 0.66;                          ///< height of the sensor on this storey
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< between four places of every grid: that of the walls' lines

  /// There is neither a wall nor a room on the storey.
  [[nodiscard]] bool empty() const { return min.x() > max.x(); }
  /// The coordinates along an axis (0: x, 1: y) at which a grid of this spacing has places, ascending.
  [[nodiscard]] std::vector<double> lines(int axis, double spacing_m) const;
};

/// Box around the walls and rooms of a storey, with the sensor's height over its floor. Walls may stand on a storey
/// below, or be glass and no walls; rooms may be unknown.
[[nodiscard]] SearchArea search_area(const bim::Building& building, std::size_t storey);

}  // namespace plumbline::scenarios
