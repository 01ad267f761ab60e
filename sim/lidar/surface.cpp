// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/surface.h"

#include "bim/mesh/visible.h"
#include "bim/model/materials.h"

namespace plumbline::sim {

std::vector<Surface> surfaces_of(const bim::Building& building, const bim::BuildingMesh& mesh, double reflectivity) {
  std::vector<Surface> surfaces;
  surfaces.reserve(mesh.elements.size());
  for (const bim::MeshElement& element : mesh.elements) {
    const bim::Material* material = bim::find_material(building, bim::material_of(building, element));
    surfaces.push_back(material == nullptr ? Surface{reflectivity, 0.0, 0.0}
                                           : Surface{material->reflectivity + retro_gain * material->retro,
                                                     material->transmission, material->specular});
  }
  return surfaces;
}

}  // namespace plumbline::sim
