// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/formats/ifc/step/step_model.h"
#include "bim/geometry/interval.h"
#include "bim/mesh/solid.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Ranges of a solid in the frame of a wall: along, across, upright.
struct WallBox {
  Interval along, across, height;
};

[[nodiscard]] WallBox box_in(const Wall& wall, const std::vector<Solid>& solids);

/// Ranges of what solids have within the thickness of a wall; of all of them where they miss it.
[[nodiscard]] WallBox box_within(const Wall& wall, const std::vector<Solid>& solids);

/// Area that two boxes have in common in the wall's elevation, m^2; 0 where they lie apart across it.
[[nodiscard]] double common_area(const WallBox& a, const WallBox& b, double slack_m);

/// What a door or window says that it takes of its wall, which its body with handles and trims exceeds: from its
/// placement, the lower left corner, where the body is there, otherwise in the middle of that and, for a door, at its
/// foot. The body's box where it says nothing, or what cannot be.
[[nodiscard]] WallBox said_box(const StepProduct& filling, const Wall& wall, const std::vector<Solid>& bodies);

[[nodiscard]] double overlap(const Interval& a, const Interval& b);
[[nodiscard]] double area(const WallBox& box);

}  // namespace plumbline::bim
