// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::scenarios {

/// What was spoilt.
enum class FaultKind {
  closed_door,       ///< the leaf is shut
  narrow_door,       ///< 0.4 to 0.6 m wide
  overlapping_wall,  ///< a wall stands in the doorway
  missing_floor      ///< there is no slab in a room
};

struct Fault {
  FaultKind kind = FaultKind::closed_door;
  std::string element;  ///< as messages name what stops the robot: "door 'd1'", "wall 'w/over'"; of a floor: empty
  std::string where;    ///< id of the door or the room
};

/// A generated building with faults, and what of it can be reached by construction: through doors that are as
/// generated, between rooms with a floor.
struct FaultyBuilding {
  std::string what;  ///< family, options and number
  bim::Building building;
  std::vector<Fault> faults;

  /// Rooms of the start's storey that one room leads to, with some faults repaired (by their index), the room included.
  [[nodiscard]] std::set<std::string> reachable(const std::string& room,
                                                const std::set<std::size_t>& repaired = {}) const;
};

/// The k-th building of a sweep over all families, their sizes and seeds, each with its own faults; absent where the
/// family cannot be built with these options.
[[nodiscard]] std::optional<FaultyBuilding> faulty_building(std::uint64_t k);

/// What a default walk through such a building does.
struct FaultyWalk {
  std::size_t reachable = 0;  ///< rooms, by construction, from its start
  std::size_t entered = 0;    ///< of these, or left out since the walk would take too long, and said so
  std::size_t missed = 0;     ///< rooms of the storey that are not reachable
  std::size_t named = 0;  ///< of these, with the faults that stop the robot: repairing them makes the room reachable
  bool refused = false;   ///< there is nowhere to walk to, and the message says why
  std::string wrong;      ///< what contradicts the construction; empty: nothing
};
[[nodiscard]] FaultyWalk walk_through(const FaultyBuilding& building);

}  // namespace plumbline::scenarios
