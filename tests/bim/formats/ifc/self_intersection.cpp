// SPDX-License-Identifier: Apache-2.0
#include "tests/bim/formats/ifc/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <map>

namespace plumbline::bim {

bool intersects_itself(const BuildingMesh& mesh, const MeshElement& element) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh surface;
  std::map<int, Mesh::Vertex_index> index;
  for (int t = 0; t < element.triangle_count; ++t) {
    std::vector<Mesh::Vertex_index> corners;
    for (const int vertex : mesh.triangles[static_cast<std::size_t>(element.first_triangle + t)]) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(vertex)];
      const auto [found, is_new] = index.try_emplace(vertex);
      if (is_new) found->second = surface.add_vertex({p.x(), p.y(), p.z()});
      corners.push_back(found->second);
    }
    if (surface.add_face(corners) == Mesh::null_face()) return true;  // not manifold
  }
  return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

}  // namespace plumbline::bim
