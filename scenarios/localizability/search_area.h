// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "bim/model/building.h"
#include "bim/model/walked_floors.h"

namespace plumbline::scenarios {

/// Where candidates are searched for: the floor of one storey.
struct SearchArea {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  bim::WalkedFloors floors;                          ///< what the robot walks on
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< between four places of every grid: that of the walls' lines

  /// There is neither a wall nor a room on the storey.
  [[nodiscard]] bool empty() const { return min.x() > max.x(); }
  /// Height in W of the levelled sensor over the floor at a place.
  [[nodiscard]] double sensor_z_W(const Eigen::Vector2d& p_W) const;
  /// The coordinates along an axis (0: x, 1: y) at which a grid of this spacing has places, ascending.
  [[nodiscard]] std::vector<double> lines(int axis, double spacing_m) const;
};

/// Box around the walls and rooms of a storey, with its floors. Walls may stand on a storey
/// below, or be glass and no walls; rooms may be unknown.
[[nodiscard]] SearchArea search_area(const bim::Building& building, std::size_t storey);

/// What the robot walks on in each storey.
[[nodiscard]] std::vector<bim::WalkedFloors> storey_floors(const bim::Building& building);
/// Height in W of the levelled sensor of a robot whose feet are at p_W: over the nearest of the floors there where that
/// is within near_m, so that scans on one floor are taken at one height; else over p_W itself, as on a stair.
[[nodiscard]] double sensor_z_W(const std::vector<bim::WalkedFloors>& floors, const Eigen::Vector3d& p_W,
                                double near_m);

}  // namespace plumbline::scenarios
