// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "bim/model/building.h"
#include "bim/random/stream.h"

namespace plumbline::bim {

/// What real files do that plans do not.
enum class BuildingFault {
  split_level,       ///< a room's floor lies 0.05 to 0.6 m above the others, its doors with it
  mezzanine,         ///< half of a room has one more floor, 2 m or more above
  overlapping_wall,  ///< a wall with a door is drawn twice, the second time thicker and without the door
  crossing_wall,     ///< a wall ends in a doorway and takes a third of it
  missing_slabs,     ///< no slab at all
  curtain_front,     ///< an outer wall is glass panels between mullions
};
inline constexpr std::array<std::string_view, 6> building_fault_names = {
    "split_level", "mezzanine", "overlapping_wall", "crossing_wall", "missing_slabs", "curtain_front"};

struct FaultyBuilding {
  Building building;
  std::string element;  ///< id of the room, wall or door that has the fault; empty: the building has no place for it,
                        ///< or all of it has
  double rise_m = 0.0;  ///< of a split level, above the floor that the room had
};

/// The building with one fault, at a place and of a size that the stream draws at `tick`; the same building where it
/// has no place for it. Written with write_ifc() and read again it is what a stranger's file would be. Elements made up
/// have ids that end in the fault's name.
[[nodiscard]] FaultyBuilding with_fault(Building building, BuildingFault fault, const Stream& stream,
                                        std::uint64_t tick);

}  // namespace plumbline::bim
