// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// Colour of an element in a viewer: linear RGB and opacity, 0 to 1.
struct Colour {
  std::string_view name;
  float red = 0.0F, green = 0.0F, blue = 0.0F;
  float opacity = 1.0F;
};

/// All colours, that of walls first.
[[nodiscard]] std::span<const Colour> palette();

/// Name of the colour by kind and material.
[[nodiscard]] std::string_view colour_of(const Obstacle& obstacle);

/// Index into palette() by the kind of the element and the material of an obstacle.
[[nodiscard]] std::size_t colour_of(const Building& building, const MeshElement& element);

}  // namespace plumbline::bim
