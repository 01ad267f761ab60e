// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/plan_map/planned_furniture.h"

#include <string>

namespace plumbline::slam::synthetic {

void add_furniture(bim::Plan& plan, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  bim::BuildingMesh& mesh = plan.furniture;
  const int base = static_cast<int>(mesh.vertices.size()), index = static_cast<int>(mesh.elements.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  bim::MeshElement element;
  element.id = "furniture" + std::to_string(index);
  element.kind = bim::ElementKind::obstacle;
  element.first_triangle = static_cast<int>(mesh.triangles.size());
  for (const Eigen::Vector4i& side :
       {Eigen::Vector4i(0, 2, 3, 1), Eigen::Vector4i(4, 5, 7, 6), Eigen::Vector4i(0, 1, 5, 4),
        Eigen::Vector4i(2, 6, 7, 3), Eigen::Vector4i(0, 4, 6, 2), Eigen::Vector4i(1, 3, 7, 5)})
    for (const Eigen::Vector3i& triangle :
         {Eigen::Vector3i(side[0], side[1], side[2]), Eigen::Vector3i(side[0], side[2], side[3])}) {
      mesh.triangles.emplace_back(triangle + Eigen::Vector3i::Constant(base));
      mesh.element.push_back(index);
    }
  element.triangle_count = static_cast<int>(mesh.triangles.size()) - element.first_triangle;
  mesh.elements.push_back(element);
}

}  // namespace plumbline::slam::synthetic
