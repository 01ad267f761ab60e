// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "bim/mesh/mesh.h"

namespace plumbline::slam::synthetic {

/// Adds an element of boxes, each with vertices of its own.
inline void add_boxes(bim::ElementKind kind, const std::vector<Eigen::AlignedBox3d>& boxes, bim::BuildingMesh& mesh) {
  bim::MeshElement element;
  element.kind = kind;
  element.first_triangle = static_cast<int>(mesh.triangles.size());
  for (const Eigen::AlignedBox3d& box : boxes) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 8; ++k) mesh.vertices.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
    for (const Eigen::Vector4i& face :
         {Eigen::Vector4i{0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
      mesh.triangles.emplace_back(first + face[0], first + face[1], first + face[2]);
      mesh.triangles.emplace_back(first + face[0], first + face[2], first + face[3]);
    }
  }
  element.triangle_count = static_cast<int>(mesh.triangles.size()) - element.first_triangle;
  mesh.element.resize(mesh.triangles.size(), static_cast<int>(mesh.elements.size()));
  mesh.elements.push_back(element);
}

}  // namespace plumbline::slam::synthetic
