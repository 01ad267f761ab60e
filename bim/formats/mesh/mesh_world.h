// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/formats/mesh/mesh_axes.h"
#include "bim/formats/mesh/mesh_file.h"
#include "bim/formats/mesh/mesh_ground.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// How a storey is found in a mesh.
struct MeshWorldConfig {
  MeshFileConfig file;
  MeshAxesConfig axes;
  MeshGroundConfig ground;
  double weld_m = 1e-5;          ///< vertices this close are one, so that closed parts are seen to be closed
  double cell_m = 0.1;           ///< of the grid on which the floor's outline is found
  std::size_t most_runs = 4000;  ///< a floor of more rectangles than this is traced in coarser cells
  double under_m = 0.01;         ///< the slab lies this much under the mesh's own floor, so that no ray meets it
  double slab_m = 0.01;          ///< thickness of that slab
  double height_m = 3.0;         ///< of a storey without anything above it
};

/// A mesh as a building without rooms: every part an obstacle named by its node, one storey, "ground", on the lowest
/// large floor, and a slab under that floor, which says where there is something to stand on; of a floor that slopes at
/// its mean height, with the slab under its lowest point. Schema "mesh".
/// Throws InputError as read_mesh_parts and settle_axes, and when nothing in it faces up.
[[nodiscard]] Building read_mesh_world(std::string_view bytes, const std::string& path,
                                       const MeshWorldConfig& config = {});

}  // namespace plumbline::bim
