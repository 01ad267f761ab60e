// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"
#include "bim/model/door_edges.h"
#include "bim/model/floors.h"

namespace plumbline::bim {

/// Thresholds of finding rooms in a model without spaces, docs/design.md.
struct RoomInferenceConfig {
  double slice_m = 1.2;         ///< height above the storey's floor at which walls are cut
  double low_slice_m = 0.6;     ///< where that encloses none: walls may end lower under a roof
  double closing_m = 0.10;      ///< walls this close to each other are taken as joined
  double least_area_m2 = 0.5;   ///< smaller gaps between walls are no rooms
  double least_height_m = 2.0;  ///< lower storeys (foundations) have no rooms
  double beside_m = 1.9;        ///< storeys this close in height lie beside each other: wings, half levels
};

/// The regions that the walls of a storey enclose, as rooms with walls and doors left closed: clear outlines, ids made
/// of the storey's id and a count in canonical order. Of storeys beside each other a room belongs to the one that most
/// of its walls are on. Open-plan divisions cannot be found. `floors`: floor_pieces of the building; `doors`: those
/// that stand in no wall.
[[nodiscard]] std::vector<Room> infer_rooms(const Building& building, int storey, const std::vector<FloorPiece>& floors,
                                            const std::vector<FreeDoor>& doors, const RoomInferenceConfig& config = {});
/// The same where the floors are not at hand, and all doors stand in walls.
[[nodiscard]] std::vector<Room> infer_rooms(const Building& building, int storey,
                                            const RoomInferenceConfig& config = {});

}  // namespace plumbline::bim
