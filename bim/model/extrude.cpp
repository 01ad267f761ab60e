// SPDX-License-Identifier: Apache-2.0
#include "bim/model/extrude.h"

#include <numeric>

#include "bim/model/triangulate.h"

namespace plumbline::bim {

namespace {

/// Corner i of triangle t has number 3 t + i. Corners at one point belong to one wedge when a fan of inside triangles
/// joins them; numbers the wedges.
class Wedges {
 public:
  explicit Wedges(const FlatMesh& mesh) : parent_(3 * mesh.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t edge = 0; edge < 3; ++edge) join_across(mesh, t, edge);
  }

  [[nodiscard]] std::size_t root(std::size_t corner) const {
    while (parent_[corner] != corner) corner = parent_[corner];
    return corner;
  }

 private:
  void join_across(const FlatMesh& mesh, std::size_t t, std::size_t edge) {
    const int neighbour = mesh.triangles[t].neighbours[edge];
    if (neighbour < 0) return;
    const auto other = static_cast<std::size_t>(neighbour);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (i != edge && mesh.triangles[t].points[i] == mesh.triangles[other].points[j]) join(3 * t + i, 3 * other + j);
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t ra = root(a), rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

  std::vector<std::size_t> parent_;
};

}  // namespace

Solid extrude_between(const Region2& region, const Placement& low, const Placement& high) {
  const FlatMesh mesh = triangulate(region);
  const Wedges wedges(mesh);
  Solid solid;
  std::vector<int> vertex(3 * mesh.triangles.size(), -1);  // low image of each corner; the high image follows it
  for (std::size_t corner = 0; corner < vertex.size(); ++corner) {
    const std::size_t root = wedges.root(corner);
    if (root == corner) {
      const auto point = static_cast<std::size_t>(mesh.triangles[corner / 3].points[corner % 3]);
      vertex[corner] = static_cast<int>(solid.vertices.size());
      solid.vertices.push_back(low(mesh.points[point]));
      solid.vertices.push_back(high(mesh.points[point]));
    } else {
      vertex[corner] = vertex[root];  // the root is the lowest corner of its wedge
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int a = vertex[3 * t], b = vertex[3 * t + 1], c = vertex[3 * t + 2];
    solid.triangles.emplace_back(a, c, b);
    solid.triangles.emplace_back(a + 1, b + 1, c + 1);
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (mesh.triangles[t].neighbours[edge] >= 0) continue;
      const int from = vertex[3 * t + (edge + 1) % 3], to = vertex[3 * t + (edge + 2) % 3];
      solid.triangles.emplace_back(from, to, to + 1);
      solid.triangles.emplace_back(from, to + 1, from + 1);
    }
  }
  return solid;
}

Solid extrude(const Region2& region, double z0_m, double z1_m) {
  return extrude_between(
      region, [&](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), z0_m); },
      [&](const Eigen::Vector2d& p) { return Eigen::Vector3d(p.x(), p.y(), z1_m); });
}

}  // namespace plumbline::bim
