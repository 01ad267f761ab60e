// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/exact_boolean.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <numeric>
#include <vector>

#include "bim/mesh/corefine.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// More triangles in an operand take seconds.
constexpr std::size_t most_triangles = 4000;

/// Shells of a closed mesh, by shared vertices.
std::vector<Solid> shells(const Solid& solid) {
  std::vector<int> root(solid.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) {
      root[static_cast<std::size_t>(i)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
      i = root[static_cast<std::size_t>(i)];
    }
    return i;
  };
  for (const Eigen::Vector3i& t : solid.triangles)
    for (int k = 1; k < 3; ++k) root[static_cast<std::size_t>(find(t[k]))] = find(t[0]);
  std::vector<int> shell_of(solid.vertices.size(), -1), place(solid.vertices.size(), -1);
  std::vector<Solid> result;
  for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
    int& shell = shell_of[static_cast<std::size_t>(find(static_cast<int>(i)))];
    if (shell < 0) {
      shell = static_cast<int>(result.size());
      result.emplace_back();
    }
    Solid& part = result[static_cast<std::size_t>(shell)];
    place[i] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(solid.vertices[i]);
  }
  for (const Eigen::Vector3i& t : solid.triangles)
    result[static_cast<std::size_t>(shell_of[static_cast<std::size_t>(find(t[0]))])].triangles.push_back(
        t.unaryExpr([&](int i) { return place[static_cast<std::size_t>(i)]; }));
  std::erase_if(result, [](const Solid& part) { return part.triangles.empty(); });
  return result;
}

std::optional<Nef> shell_to_nef(const Solid& shell) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Eigen::Vector3d& p : shell.vertices)
    vertices.push_back(mesh.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z())));
  for (const Eigen::Vector3i& t : shell.triangles) {
    const auto v = [&](int k) { return vertices[static_cast<std::size_t>(t[k])]; };
    if (mesh.add_face(v(0), v(1), v(2)) == Mesh::null_face()) return std::nullopt;
  }
  return Nef(mesh);
}

/// The solid as the union of its shells, less those that bound a hollow in it.
std::optional<Nef> to_nef(const Solid& solid, double grid_m) {
  const std::optional<Solid> closed = repaired(solid, grid_m);
  if (!closed || closed->triangles.size() > most_triangles) return std::nullopt;
  std::optional<Nef> all;
  std::vector<Nef> hollows;
  for (const Solid& shell : shells(*closed)) {
    if (runs_through_itself(shell)) return std::nullopt;
    const double v = volume(shell);
    if (v == 0.0) continue;
    const std::optional<Nef> part = shell_to_nef(turned_outward(shell));
    if (!part) return std::nullopt;
    if (v < 0.0)
      hollows.push_back(*part);
    else
      all = all ? *all + *part : *part;
  }
  if (!all) return std::nullopt;
  for (const Nef& hollow : hollows) *all -= hollow;
  return all;
}

Solid to_soup(const Nef& nef) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  CGAL::convert_nef_polyhedron_to_polygon_soup(nef, points, polygons, true);
  Solid soup;
  for (const Kernel::Point_3& p : points)
    soup.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
  for (const std::vector<std::size_t>& polygon : polygons)
    if (polygon.size() == 3)
      soup.triangles.emplace_back(static_cast<int>(polygon[0]), static_cast<int>(polygon[1]),
                                  static_cast<int>(polygon[2]));
  return soup;
}

}  // namespace

std::optional<Solid> exact_boolean(const Solid& body, std::span<const BooleanStep> steps, double grid_m) {
  try {
    std::optional<Nef> rest = to_nef(body, grid_m);
    if (!rest) return std::nullopt;
    for (const BooleanStep& step : steps) {
      const std::optional<Nef> other = to_nef(step.other, grid_m);
      if (!other) return std::nullopt;
      *rest = (step.operation == BooleanOperation::difference ? *rest - *other : *rest * *other).regularization();
    }
    if (rest->is_empty()) return Solid{};
    Solid soup = welded(to_soup(*rest), grid_m);
    if (is_closed(soup)) return turned_outward(soup);
    Solid separated = turned_outward(touching_parts_separated(soup));
    if (!is_closed(separated)) return std::nullopt;
    return separated;
  } catch (const std::exception&) {  // a CGAL precondition that bad input breaks
    return std::nullopt;
  }
}

}  // namespace plumbline::bim
