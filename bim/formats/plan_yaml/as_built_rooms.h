// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "bim/formats/plan_yaml/deviations.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Thresholds of following rooms from plan to building.
struct AsBuiltRoomConfig {
  double same_share = 0.01;   ///< a room is what walls enclose when the two differ by less than this share of it
  double same_m2 = 1e-3;      ///< outlines that differ by less are the same
  double remnant_m2 = 0.5;    ///< a smaller piece is no room
  double open_plan_m2 = 0.1;  ///< what shares this much with an open-plan room is not enclosed
};

/// Gives `as_built`, whose walls stand as built and whose rooms are the planned ones, its own rooms on the given
/// storeys, and names the changes. Indices of rooms in other elements follow.
void rebuild_rooms(const Building& as_planned, const std::set<int>& storeys, Building& as_built,
                   std::vector<Change>& changes, const AsBuiltRoomConfig& config = {});

}  // namespace plumbline::bim
