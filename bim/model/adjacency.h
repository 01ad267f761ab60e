// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// The connection from a room to its neighbour.
enum class Passage { door, window, opening_void, open_edge, stair };

/// Two rooms that meet. a is a room; b another, or -1 for outside (or unknown).
struct Adjacent {
  int a = -1;
  int b = -1;
  Passage by = Passage::door;
  std::string element;   ///< id of the opening or stair; empty for an open edge
  double width_m = 0.0;  ///< of the opening, the open edge or the stair's first flight
};

/// Of each opening whether it is no passage of its own but the same hole as another: a void in a wall that stands upon
/// or before the wall of a door, or of a void listed earlier, between the same rooms.
[[nodiscard]] std::vector<bool> continued_openings(const Building& building);

/// Which rooms meet, and how: through the openings of walls (Opening::rooms), where no wall stands between them
/// (Room::virtual_edges, with the doors that stand there) and over stairs (Stair::rooms). One entry an opening that
/// does not continue another, door, stair or pair of rooms with an open edge; rooms that meet in two ways stand twice.
/// Sorted by a, b, kind, element.
[[nodiscard]] std::vector<Adjacent> adjacency(const Building& building);

}  // namespace plumbline::bim
