// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {

/// One counter-clockwise triangle. Edge i lies opposite to corner i.
struct FlatTriangle {
  std::array<int, 3> points = {};      ///< into FlatMesh::points
  std::array<int, 3> neighbours = {};  ///< into FlatMesh::triangles across edge i, -1 on the region's boundary
};

struct FlatMesh {
  std::vector<Eigen::Vector2d> points;
  std::vector<FlatTriangle> triangles;
};

/// Constrained Delaunay triangulation of a region. Of points on one circle the lexicographically lowest gets the
/// diagonals, and points and triangles are sorted, so that the result depends on the region alone. A point that a ring
/// repeats counts once. Throws InternalError when rings cross each other.
[[nodiscard]] FlatMesh triangulate(const Region2& region);

}  // namespace plumbline::bim
