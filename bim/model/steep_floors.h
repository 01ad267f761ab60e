// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/walked_floors.h"

namespace plumbline::bim {

/// A sloping floor that a robot does not walk.
struct SteepFloor {
  std::string name;           ///< "ramp 'id'" or "slab 'id'"
  PolygonWithHoles2 polygon;  ///< on the plan
  double slope = 0.0;         ///< tangent
};

/// Ramps and sloping slabs that begin or end at the ground of a storey and are steeper than walked_floors() takes; up
/// to a tangent of 1, since what is steeper is no floor by any name.
[[nodiscard]] std::vector<SteepFloor> steep_floors(const Building& as_built, int storey, double ground_m,
                                                   const WalkedFloorConfig& config = {});

/// "ramp 'id' rises by 25 %, and the robot walks up to 20 %".
[[nodiscard]] std::string too_steep_text(const SteepFloor& floor, const WalkedFloorConfig& config = {});

}  // namespace plumbline::bim
