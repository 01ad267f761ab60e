// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// What an element looks like in a viewer: linear colour and opacity, 0 to 1.
struct Paint {
  std::string_view name;
  float red = 0.0F, green = 0.0F, blue = 0.0F;
  float opacity = 1.0F;
};

/// All paints, the one of walls first.
[[nodiscard]] std::span<const Paint> paints();

/// Name of its paint by kind and material.
[[nodiscard]] std::string_view paint_of(const Obstacle& obstacle);

/// Index into paints() by the kind of the element and the material of an obstacle.
[[nodiscard]] std::size_t paint_of(const Building& building, const MeshElement& element);

}  // namespace plumbline::bim
