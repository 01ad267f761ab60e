// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "bim/furniture/shapes.h"
#include "bim/model/building.h"

namespace plumbline::bim {

enum class RoomUse { bedroom, living, kitchen, bath, office, meeting, store, workshop, classroom, hall, corridor };

/// By a word of the room's name or id, English or German, that begins or ends a word of it; else by its area and shape.
[[nodiscard]] RoomUse use_of(const Room& room);

/// Where a kind of furniture stands.
enum class Spot {
  wall,    ///< its back to a wall
  middle,  ///< where most space is
  beside   ///< beside other pieces, or wherever it fits
};

/// One kind of piece that a room gets.
struct FurnitureItem {
  FurnitureShape shape;
  std::array<double, 3> smallest, largest;  ///< m, along its own axes
  Spot spot;
  int most;        ///< of them, in a room
  int chairs = 0;  ///< at most, around each
};

/// What belongs into a room, the most important first; the last ones fill it.
[[nodiscard]] std::span<const FurnitureItem> items_of(RoomUse use);

}  // namespace plumbline::bim
