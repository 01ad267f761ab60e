// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::scenarios {

/// Puts all rooms of a building whose floors lie at 0, and the doors and passages between them, on raised floors.
inline void raise_rooms(bim::Building& building, double rise_m) {
  for (bim::Room& room : building.rooms) {
    bim::Slab slab;
    slab.id = room.id + "/raised";
    slab.storey = room.storey;
    slab.polygon = {room.polygon, {}};
    slab.z0_m = room.z0_m;
    slab.z1_m = room.z0_m = rise_m;
    building.slabs.push_back(slab);
  }
  for (bim::Opening& opening : building.openings)
    if (opening.kind != bim::OpeningKind::window) opening.z0_m = rise_m;
}

}  // namespace plumbline::scenarios
