// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

struct BlockedDoorConfig {
  double before_m = 0.3;    ///< what stands this near before a doorway is in the way
  double passable_m = 0.7;  ///< a robot needs this much of its width free
  double low_m = 0.05;      ///< what ends below this above the sill is stepped over
  double high_m = 1.0;      ///< what begins above this is walked under
  double head_m = 1.2;      ///< openings of the other wall with a lower head are not passed
  double sill_m = 0.2;      ///< a void that begins higher above its storey is a niche or a hatch
};

/// Warns of open doors and voids in which another wall, but for its own openings, or a column leaves no stretch wide
/// enough. Walls count as rectangles on the plan.
void warn_of_blocked_doors(Building& building, const BlockedDoorConfig& config = {});

}  // namespace plumbline::bim
