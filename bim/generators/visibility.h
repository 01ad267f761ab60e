// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

struct VisibilityConfig {
  double sensor_height_m = 0.66;  ///< height of the LiDAR above the floor (identify's sensor_z_W)
  double clearance_m = 0.35;      ///< a robot's centre keeps this far from a room's outline
  double grid_m = 0.5;            ///< spacing of the viewpoints
};

/// Rooms of a storey with a viewpoint that has a line of sight to one of the points, at the LiDAR's height,
/// through open doors and whatever light goes through.
[[nodiscard]] std::vector<std::string> rooms_that_see(const Building& building, int storey,
                                                      const std::vector<Eigen::Vector2d>& points,
                                                      const VisibilityConfig& config = {});

}  // namespace plumbline::bim
