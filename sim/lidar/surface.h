// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/model/building.h"

namespace plumbline::sim {

/// What sends light back where it came from gives this many times what a white wall gives.
inline constexpr double retro_gain = 100.0;

/// What an element's surface does to light: shares of it, 0 to 1.
struct Surface {
  double reflectivity = 0.5;  ///< given back diffusely; above 1 a retro-reflector
  double transmission = 0.0;  ///< let through the whole body, such as a pane
  double specular = 0.0;      ///< mirrored

  [[nodiscard]] bool plain() const { return transmission == 0.0 && specular == 0.0; }
};

/// Surfaces by element id of the mesh. An element whose material is not known reflects `reflectivity`.
[[nodiscard]] std::vector<Surface> surfaces_of(const bim::Building& building, const bim::BuildingMesh& mesh,
                                               double reflectivity);

}  // namespace plumbline::sim
