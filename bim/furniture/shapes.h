// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Furniture with legs and hollows, so that beams pass below and between as they do in rooms that are lived in.
enum class FurnitureShape {
  table,     ///< top on four legs
  desk,      ///< top on two side panels, with a modesty panel at the back
  chair,     ///< seat on four legs, with a back
  bed,       ///< mattress in a frame on four legs, with a headboard
  sofa,      ///< seat, back and two arms
  shelf,     ///< sides, boards and back panel, open to the front
  wardrobe,  ///< closed, on four feet
  kitchen,   ///< base units on a plinth, worktop that overhangs, a tall unit at one end
  machine,   ///< body with a console
  pallet,    ///< slats, bearers and load
  person     ///< sitting: lower legs, lap, torso, head
};
[[nodiscard]] constexpr std::array<std::string_view, 11> names_of(FurnitureShape) {
  return {"table", "desk", "chair", "bed", "sofa", "shelf", "wardrobe", "kitchen", "machine", "pallet", "person"};
}

/// Closed boxes that fill the size exactly, m, in the piece's own frame: origin in the middle of its floor area, x
/// along size.x, front towards -y (back, headboard and wall side at +y), z up. Sizes below 1 cm are InternalErrors.
[[nodiscard]] Solid furniture_solid(FurnitureShape shape, const Eigen::Vector3d& size);
/// The same in W: centre of its floor area, yaw in rad and height of the floor, m.
[[nodiscard]] Solid furniture_solid(FurnitureShape shape, const Eigen::Vector3d& size, const Eigen::Vector2d& at,
                                    double yaw, double floor_z_m);

}  // namespace plumbline::bim
