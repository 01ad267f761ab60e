// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/corefine.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <exception>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/exact_boolean.h"
#include "bim/mesh/shells.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::optional<Mesh> to_mesh(const Solid& solid, double grid_m) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Eigen::Vector3d& p : solid.vertices)
    points.emplace_back(snap(p.x(), grid_m), snap(p.y(), grid_m), snap(p.z(), grid_m));
  for (const Eigen::Vector3i& t : solid.triangles)
    triangles.push_back(
        {static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
  pmp::repair_polygon_soup(points, triangles);
  pmp::orient_polygon_soup(points, triangles);  // doubles points where the surface touches itself
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  if (mesh.is_empty() || !CGAL::is_closed(mesh)) return std::nullopt;
  try {
    pmp::orient_to_bound_a_volume(mesh);
  } catch (const std::exception&) {  // flat at its lowest corner: where CGAL checks its own conditions
    return std::nullopt;
  }
  return mesh;
}

/// None where a face is no triangle, as corefinement may leave one where two surfaces almost touch.
std::optional<Solid> to_solid(const Mesh& mesh) {
  Solid solid;
  std::vector<int> index(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), -1);
  for (const auto vertex : mesh.vertices()) {
    const Kernel::Point_3& p = mesh.point(vertex);
    index[static_cast<std::size_t>(vertex)] = static_cast<int>(solid.vertices.size());
    solid.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    Eigen::Vector3i triangle;
    int corner = 0;
    for (const auto vertex : CGAL::vertices_around_face(mesh.halfedge(face), mesh)) {
      if (corner == 3) return std::nullopt;
      triangle[corner++] = index[static_cast<std::size_t>(vertex)];
    }
    if (corner != 3) return std::nullopt;
    solid.triangles.push_back(triangle);
  }
  return solid;
}

template <class Operation>
std::optional<Solid> corefined(const Solid& first, const Solid& second, double grid_m, const Operation& operation) {
  std::optional<Mesh> a = to_mesh(first, grid_m), b = to_mesh(second, grid_m);
  if (!a || !b) return std::nullopt;
  Mesh result;
  try {
    if (!operation(*a, *b, result)) return std::nullopt;  // the result would not be manifold
  } catch (const std::exception&) {  // self-intersection, or a CGAL precondition that bad input breaks
    return std::nullopt;
  }
  return to_solid(result);
}

}  // namespace

std::optional<Solid> repaired(const Solid& solid, double grid_m) {
  // Joining points would make one surface of shells that touch, and a hollow of one within another.
  if (shells_may_overlap(solid, grid_m))
    if (const std::optional<Solid> whole = exact_boolean(solid, {}, grid_m)) return canonical(*whole, grid_m);
  const std::optional<Mesh> mesh = to_mesh(solid, grid_m);
  if (!mesh) return std::nullopt;
  return to_solid(*mesh);
}

bool runs_through_itself(const Solid& closed) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Eigen::Vector3d& p : closed.vertices) vertices.push_back(mesh.add_vertex({p.x(), p.y(), p.z()}));
  for (const Eigen::Vector3i& t : closed.triangles) {
    const auto v = [&](int k) { return vertices[static_cast<std::size_t>(t[k])]; };
    if (mesh.add_face(v(0), v(1), v(2)) == Mesh::null_face()) return true;
  }
  return pmp::does_self_intersect(mesh);
}

std::optional<Solid> difference(const Solid& body, const Solid& cutter, double grid_m) {
  return corefined(body, cutter, grid_m, [](Mesh& a, Mesh& b, Mesh& result) {
    return pmp::corefine_and_compute_difference(a, b, result, CGAL::parameters::throw_on_self_intersection(true));
  });
}

std::optional<Solid> intersection(const Solid& a, const Solid& b, double grid_m) {
  return corefined(a, b, grid_m, [](Mesh& left, Mesh& right, Mesh& result) {
    return pmp::corefine_and_compute_intersection(left, right, result,
                                                  CGAL::parameters::throw_on_self_intersection(true));
  });
}

}  // namespace plumbline::bim
