// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// What makes a storey one to walk on.
struct StoreyKindConfig {
  double person_m = 1.8;  ///< something upright reaches this far above the floor
  double knee_m = 1.0;    ///< ... and begins no higher than this above it
  double floor_m = 0.35;  ///< a slab is the floor when its top lies this close to the storey's elevation
  double least_m2 = 4.0;  ///< ... and has this area, at least
  double beside_m = 0.5;  ///< walls of another storey this near to its rooms, and as high as they, are its own as well
};

/// Fills Storey::kind. Habitable is what has upright elements and rooms, a floor or a door at its height; of the others
/// those below the lowest habitable storey are foundations, the rest roofs. A building without rooms and floors is
/// taken by its upright elements alone; one without those is habitable throughout, with a warning.
void set_storey_kinds(Building& building, const StoreyKindConfig& config = {});

[[nodiscard]] bool has_room(const Building& building, int storey);

/// A door of the storey's walls begins at its height: people walk there.
[[nodiscard]] bool has_door(const Building& building, int storey, const StoreyKindConfig& config = {});

}  // namespace plumbline::bim
