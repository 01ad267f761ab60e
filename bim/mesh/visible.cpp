// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/visible.h"

#include "bim/model/materials.h"

namespace plumbline::bim {

const std::string& material_of(const Building& building, const MeshElement& element) {
  const auto i = static_cast<std::size_t>(element.index);
  switch (element.kind) {
    case ElementKind::wall:
      return building.walls[i].material;
    case ElementKind::slab:
      return building.slabs[i].material;
    case ElementKind::column:
      return building.columns[i].material;
    case ElementKind::stair:
      return building.stairs[i].material;
    case ElementKind::obstacle:
      break;
  }
  return building.obstacles[i].material;
}

BuildingMesh visible_mesh(const Building& building, const BuildingMesh& mesh) {
  BuildingMesh visible{mesh.vertices, {}, {}, mesh.elements, mesh.warnings};
  for (MeshElement& element : visible.elements) {
    const int first = element.first_triangle;
    element.first_triangle = static_cast<int>(visible.triangles.size());
    if (is_see_through(building, material_of(building, element))) {
      element.triangle_count = 0;
      continue;
    }
    const auto from = mesh.triangles.begin() + first;
    visible.triangles.insert(visible.triangles.end(), from, from + element.triangle_count);
    const auto number = static_cast<int>(&element - visible.elements.data());
    visible.element.insert(visible.element.end(), static_cast<std::size_t>(element.triangle_count), number);
  }
  return visible;
}

}  // namespace plumbline::bim
