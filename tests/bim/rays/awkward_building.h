// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <numbers>

#include "tests/bim/rays/box_mesh.h"

namespace plumbline::bim {

/// A point of the building below as it was drawn, 16.2 x 10 x 3 m, where it stands.
inline Eigen::Vector3d in_awkward_building(const Eigen::Vector3d& p) {
  const double yaw = 37.0 * std::numbers::pi / 180.0;
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * p + Eigen::Vector3d(31.4, -27.2, 0.5);
}

/// Walls that are flush (end to end, and side by side with a common side), overlapping (crossing, corners, T), and
/// there twice with the same and with reversed triangles, on a floor under a ceiling, with furniture against them and
/// on each other; all turned by 37 degrees.
inline BuildingMesh awkward_building() {
  BuildingMesh mesh;
  const auto wall = [&](double x0, double y0, double x1, double y1) { add_box(mesh, {x0, y0, 0}, {x1, y1, 3}); };
  for (int i = 0; i < 4; ++i) {
    const double x = 4.0 * i;
    wall(x, 0, x + 0.2, 5);
    wall(x, 5, x + 0.2, 10);  // flush, end to end
    wall(x, 0, x + 4, 0.2);   // corners overlap
    wall(x, 9.8, x + 4, 10);
    wall(x, 4.9, x + 4, 5.1);                         // crosses
    if (i % 2 == 0) wall(x, 0, x + 0.2, 5);           // duplicate
    if (i % 2 == 1) wall(x + 0.2, 2, x + 0.35, 4);    // side by side: its side is in the other's
    if (i % 2 == 1) wall(x, 5.5, x + 0.2 + 5e-5, 8);  // half a tie distance beyond
    for (int k = 0; k < 6; ++k) {
      const double u = x + 0.6 + 0.5 * k;
      add_box(mesh, {u, 0.2, 0}, {u + 0.5, 0.8, 0.9});  // in a row along the wall
      add_box(mesh, {u + 0.1, 0.3, 0.9}, {u + 0.3, 0.5, 1.1}, 0.2 * k);
      add_box(mesh, {u, 6.0, 0}, {u + 0.3, 6.3, 0.4}, 0.3 * k);
    }
  }
  wall(16, 0, 16.2, 10);
  add_box(mesh, {0, 0, -0.2}, {16.2, 10, 0});
  add_box(mesh, {0, 0, 3}, {16.2, 10, 3.2});
  add_box(mesh, {0, 0, -0.2}, {8, 10, 0});  // a second slab in the first
  for (Eigen::Vector3d& v : mesh.vertices) v = in_awkward_building(v);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7)
    mesh.triangles[i] = Eigen::Vector3i(mesh.triangles[i][1], mesh.triangles[i][2], mesh.triangles[i][0]);
  return mesh;
}

}  // namespace plumbline::bim
