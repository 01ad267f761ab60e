// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/model/building.h"

namespace plumbline::sim {

/// Reflectivity of a retro-reflector over that of a white wall.
inline constexpr double retro_gain = 100.0;

/// Optical properties of an element's surface, shares from 0 to 1.
struct Surface {
  double reflectivity = 0.5;  ///< given back diffusely; above 1 a retro-reflector
  double transmission = 0.0;  ///< let through the whole body, such as a pane
  double specular = 0.0;      ///< mirrored

  [[nodiscard]] bool is_diffuse() const { return transmission == 0.0 && specular == 0.0; }
};

/// Surfaces by element id of the mesh. An element whose material is not known reflects `reflectivity`.
[[nodiscard]] std::vector<Surface> surfaces_of(const bim::Building& building, const bim::BuildingMesh& mesh,
                                               double reflectivity);

}  // namespace plumbline::sim
