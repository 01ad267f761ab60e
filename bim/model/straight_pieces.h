// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {

/// When the section of a wall is taken apart.
struct StraightPiecesConfig {
  double most_thickness_m = 1.5;
  double least_length_m = 0.5;
  double slimness = 1.5;         ///< a piece is at least this many times as long as thick
  std::size_t most_pieces = 12;  ///< a wall of more is curved
  std::size_t most_strips = 48;  ///< longest stretches between two faces that are tried for each piece
  double least_rest_m2 = 5e-3;   ///< what no piece holds
};

/// The section of a wall that is a ring or has corners or branches, taken apart into convex straight pieces between two
/// parallel faces, the largest first. Empty where anything would be left over, as in a curved wall, and where the
/// section is one piece already.
[[nodiscard]] std::vector<Polygon2> straight_pieces(const Region2& section, const StraightPiecesConfig& config = {});

}  // namespace plumbline::bim
