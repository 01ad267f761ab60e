// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "bim/model/building.h"

namespace plumbline::bim {

inline void add_solid(const Solid& part, Solid& whole) {
  const int first = static_cast<int>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Eigen::Vector3i& t : part.triangles) whole.triangles.emplace_back(t.array() + first);
}

/// An upright box, its faces outward; the four sides come first.
inline Solid box_solid(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Solid box;
  for (const double z : {low.z(), high.z()}) {
    box.vertices.emplace_back(low.x(), low.y(), z);
    box.vertices.emplace_back(high.x(), low.y(), z);
    box.vertices.emplace_back(high.x(), high.y(), z);
    box.vertices.emplace_back(low.x(), high.y(), z);
  }
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    box.triangles.emplace_back(i, j, 4 + j);
    box.triangles.emplace_back(i, 4 + j, 4 + i);
  }
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, std::array{0, 3, 2}, std::array{4, 5, 6}, std::array{4, 6, 7}})
    box.triangles.emplace_back(a, b, c);
  return box;
}

/// 4 m along x, 0.2 m thick and 3 m high, with its body.
inline Wall thick_wall() {
  Wall wall;
  wall.id = "w";
  wall.storey = 0;
  wall.a = {0.0, 0.0};
  wall.b = {4.0, 0.0};
  wall.offset_m = -0.1;
  wall.thickness_m = 0.2;
  wall.z0_m = 0.0;
  wall.z1_m = 3.0;
  wall.body = box_solid({0.0, -0.1, 0.0}, {4.0, 0.1, 3.0});
  return wall;
}

/// Through the middle of it, from y0 to y1.
inline Opening thick_opening(double y0, double y1) {
  Opening opening;
  opening.wall = 0;
  opening.s_m = 2.0;
  opening.width_m = 1.0;
  opening.z0_m = 0.0;
  opening.z1_m = 2.1;
  opening.solid = box_solid({1.5, y0, 0.0}, {2.5, y1, 2.1});
  return opening;
}

}  // namespace plumbline::bim
