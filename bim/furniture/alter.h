// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// How furniture as built differs from furniture as planned.
enum class FurnitureWorld {
  as_planned,
  moved,    ///< each piece by up to 0.5 m and 20 degrees
  swapped,  ///< a third is gone or has another shape
  more,     ///< as many pieces again, not planned
  unknown   ///< all planned furniture gone, another layout of the same density instead
};
[[nodiscard]] constexpr std::array<std::string_view, 5> names_of(FurnitureWorld) {
  return {"as_planned", "moved", "swapped", "more", "unknown"};
}

/// Numbers of pieces.
struct FurnitureChanges {
  int moved = 0;
  int gone = 0;
  int swapped = 0;
  int added = 0;
};

/// Changes what may have moved (permanence_of == furniture) of a building as built. A moved piece keeps its id and
/// stays planned; one that stands instead of another or besides is a new obstacle of kind "furniture" that is not
/// planned. Every change keeps to the rules of furnish(): the piece stays in its room and free of others, doors stay
/// connected. A piece that cannot be changed so stays as it is. The same seed gives the same building.
FurnitureChanges alter_furniture(Building& as_built, FurnitureWorld world, std::uint64_t seed);

}  // namespace plumbline::bim
