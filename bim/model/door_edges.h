// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"
#include "bim/model/rooms.h"

namespace plumbline::bim {

/// A door that stands in no wall, as one between the panels of a curtain wall.
struct FreeDoor {
  std::string id;
  Solid body;  ///< in W
};

/// Names each door at the virtual edges of the rooms on its two sides, which are cut to its width there, or made where
/// its body was in the way. A door with the same room, or none, on both sides is left out, and so is one whose body is
/// not flat.
void add_door_edges(Building& building, const std::vector<FreeDoor>& doors, const AdjacencyConfig& config = {});

}  // namespace plumbline::bim
