// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "bim/mesh/mesh.h"

namespace plumbline::bim {

/// Appends one element: a triangle soup given by corners in W.
inline void add_element(BuildingMesh& mesh, const std::vector<Eigen::Vector3d>& vertices,
                        const std::vector<Eigen::Vector3i>& triangles) {
  const int element = static_cast<int>(mesh.elements.size());
  const int first_vertex = static_cast<int>(mesh.vertices.size());
  MeshElement e;
  e.id = "e" + std::to_string(element);
  e.first_triangle = static_cast<int>(mesh.triangles.size());
  e.triangle_count = static_cast<int>(triangles.size());
  mesh.vertices.insert(mesh.vertices.end(), vertices.begin(), vertices.end());
  for (const Eigen::Vector3i& t : triangles) {
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first_vertex));
    mesh.element.push_back(element);
  }
  mesh.elements.push_back(e);
}

/// Appends a closed axis-aligned box, turned by yaw (rad) about the z axis through its centre. Normals point outwards.
inline void add_box(BuildingMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double yaw = 0.0) {
  const Eigen::Vector3d center = 0.5 * (low + high);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                            (i & 4) != 0 ? high.z() : low.z());
    corners.push_back(yaw == 0.0 ? p : Eigen::Vector3d(center + turn * (p - center)));
  }
  add_element(mesh, corners,
              {{0, 2, 1},
               {1, 2, 3},
               {4, 5, 6},
               {5, 7, 6},
               {0, 1, 4},
               {1, 5, 4},
               {2, 6, 3},
               {3, 6, 7},
               {0, 4, 2},
               {2, 4, 6},
               {1, 3, 5},
               {3, 7, 5}});
}

/// Closed box of walls 0.2 m thick around [0, size], floor and ceiling: elements 0-3 walls, 4 floor, 5 ceiling. The
/// walls overlap in the corners.
inline BuildingMesh box_room(const Eigen::Vector3d& size) {
  constexpr double t = 0.2;
  BuildingMesh mesh;
  const double x = size.x();
  const double y = size.y();
  const double z = size.z();
  add_box(mesh, {-t, -t, 0.0}, {x + t, 0.0, z});
  add_box(mesh, {-t, y, 0.0}, {x + t, y + t, z});
  add_box(mesh, {-t, -t, 0.0}, {0.0, y + t, z});
  add_box(mesh, {x, -t, 0.0}, {x + t, y + t, z});
  add_box(mesh, {-t, -t, -t}, {x + t, y + t, 0.0});
  add_box(mesh, {-t, -t, z}, {x + t, y + t, z + t});
  return mesh;
}

}  // namespace plumbline::bim
