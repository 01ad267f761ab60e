// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/plan_mesh.h"

#include <algorithm>
#include <array>

#include "slam/plan_map/intervals.h"

namespace plumbline::slam {

namespace {

void add_quad(bim::BuildingMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, int element) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)}) {
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
    mesh.element.push_back(element);
  }
}

/// Upright strips between the sides of the holes.
void add_face(bim::BuildingMesh& mesh, const PlanSegment& segment, int element) {
  std::vector<double> cuts = {0.0, segment.length};
  for (const bim::FaceHole& hole : segment.holes)
    for (const double s : {hole.s0, hole.s1})
      if (s > 0.0 && s < segment.length) cuts.push_back(s);
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const double s0 = cuts[k], s1 = cuts[k + 1];
    if (s1 - s0 < 1e-9) continue;
    std::vector<Interval> holes;
    for (const bim::FaceHole& hole : segment.holes)
      if (hole.s0 < 0.5 * (s0 + s1) && hole.s1 > 0.5 * (s0 + s1)) holes.push_back({hole.z0, hole.z1});
    const Eigen::Vector2d a = segment.a + s0 * segment.e, b = segment.a + s1 * segment.e;
    for (const auto& [z0, z1] : rest_of(segment.z0, segment.z1, holes))
      add_quad(mesh, {{{a.x(), a.y(), z0}, {b.x(), b.y(), z0}, {b.x(), b.y(), z1}, {a.x(), a.y(), z1}}}, element);
  }
}

}  // namespace

bim::BuildingMesh plan_mesh(const StoreyIndex& storey) {
  bim::BuildingMesh mesh;
  for (const PlanSegment& segment : storey.segments) {
    add_face(mesh, segment, segment.element);
    mesh.elements.emplace_back();
  }
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;
  if (!mesh.vertices.empty()) low = high = mesh.vertices.front().head<2>();
  for (const Eigen::Vector3d& p : mesh.vertices) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  for (const double z : {storey.floor_z, storey.ceiling_z}) {
    add_quad(mesh, {{{low.x(), low.y(), z}, {high.x(), low.y(), z}, {high.x(), high.y(), z}, {low.x(), high.y(), z}}},
             static_cast<int>(mesh.elements.size()));
    mesh.elements.emplace_back().kind = bim::ElementKind::slab;
  }
  return mesh;
}

}  // namespace plumbline::slam
