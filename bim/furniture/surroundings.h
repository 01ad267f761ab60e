// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/furniture/footprint.h"
#include "bim/model/building.h"

namespace plumbline::bim {

struct WalkableConfig {
  double radius_m = 0.4;        ///< of the robot that must still get everywhere
  double turn_m = 0.6;          ///< clearance that one place of a room keeps, to turn round
  double cell_m = 0.1;          ///< of the grid, from the low corner of the room's box
  double gap_m = 0.05;          ///< between pieces, and to walls
  double door_deep_m = 0.95;    ///< free in front of a wall's face at an opening
  double door_beside_m = 0.15;  ///< ... and beside the opening
  double stair_deep_m = 1.2;    ///< free before the first and behind the last step
  double stair_beside_m = 0.2;  ///< ... and beside the flight
  double band_low_m = 0.05;     ///< what ends below this above the floor is in nobody's way
  double band_high_m = 1.8;     ///< nor what begins above this
  double sill_max_m = 0.3;      ///< an opening with a higher sill is no door
  double passage_min_m = 0.6;   ///< nor is one this narrow
  double cells_max = 4e6;       ///< a larger room stays as it is
};

/// The extents of a building's elements, found once for all rooms.
class Surroundings {
 public:
  explicit Surroundings(const Building& building);

  /// Everything that stands on a floor within a box: walls, columns, stairs, holes of slabs, sloping slabs; obstacles
  /// but for those left out (indices, ascending).
  [[nodiscard]] std::vector<Footprint> near(const Eigen::AlignedBox2d& box, double floor_z_m,
                                            const std::vector<int>& without, const WalkableConfig& config) const;

 private:
  const Building& building_;
  std::vector<Eigen::AlignedBox3d> walls_, columns_, obstacles_, stairs_, slabs_;
};

/// Areas that stay free: in front of doors and open edges, before and behind stairs. Convex.
[[nodiscard]] std::vector<Polygon2> keep_clear(const Building& building, const Room& room, double floor_z_m,
                                               const WalkableConfig& config);

}  // namespace plumbline::bim
