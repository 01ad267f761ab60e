// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/plan_deviation.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// One element that is not as planned. op: a DeviationOp by name; or what follows from one, remove_opening (its wall
/// went), reshape_room, drop_room (no longer enclosed, or one room with a larger one) and add_room (cut off another).
struct Change {
  std::string op;
  std::string element;  ///< id; of what was removed, its id in the plan
};

struct AsBuilt {
  Building building;
  std::vector<Change> changes;  ///< in the order of the deviations, rooms last
};

/// Applies the deviations to the plan, one after the other; elements that are in both keep their ids.
/// - A moved wall takes its openings along; walls that met it stay where they are. A removed one takes them away.
/// - A tilted wall turns about its foot line with its openings; its lower edge stays.
/// - Rooms follow the walls of their storey: a room that walls enclosed as planned gets the outline that walls enclose
///   as built; one that is open to the outside or to an open plan is dropped, and of rooms that became one the largest
///   part stays. Rooms of an open plan keep their outline, less what walls cover.
/// - Slabs stay as planned.
/// `list` is what the entries were read from. Throws InputError at the entry or value that cannot be built: an unknown
/// or taken id, a wall without length, an opening that leaves its wall or overlaps another.
[[nodiscard]] AsBuilt apply_deviations(const Building& as_planned, const std::vector<PlanDeviationEntry>& deviations,
                                       const Tree& list);

}  // namespace plumbline::bim
