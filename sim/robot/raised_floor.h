// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"

namespace plumbline::sim {

/// Floors of a storey that the robot can stand on though they lie above its elevation.
struct RaisedFloorConfig {
  double level_m = 0.05;    ///< no higher than this is the storey's own floor
  double highest_m = 1.2;   ///< above its elevation
  double doorway_m = 0.05;  ///< the threshold of a door this near in height belongs to the raised floor,
  double beside_m = 0.35;   ///< and this near to it on the plan
};

/// Level floor above a storey's elevation.
struct RaisedFloor {
  PolygonWithHoles2 polygon;  ///< on the plan
  double z_W = 0.0;
};

/// Raised floors of a storey from the lowest up, with the thresholds of open doors that lead to them.
[[nodiscard]] std::vector<RaisedFloor> raised_floors(const bim::Building& as_built, int storey,
                                                     const RaisedFloorConfig& config = {});

}  // namespace plumbline::sim
