// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/furniture/draws.h"
#include "bim/furniture/piece.h"
#include "bim/furniture/room_space.h"
#include "bim/furniture/room_use.h"

namespace plumbline::bim {

/// How much furniture a room gets.
struct LayoutOrder {
  double target_m2 = 0.0;  ///< floor under all pieces together; the last one may miss it by half of itself
  int pieces_max = 2000;
};

/// Chooses and places furniture in a room until the order is met or nothing more fits. Pieces stay in the space. They
/// have no ids yet.
[[nodiscard]] std::vector<FurniturePiece> lay_out(const Room& room, RoomSpace& space, const LayoutOrder& order,
                                                  Draws& draws);

}  // namespace plumbline::bim
