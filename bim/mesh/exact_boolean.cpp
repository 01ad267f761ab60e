// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/exact_boolean.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include "bim/mesh/corefine.h"
#include "bim/mesh/shells.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// More triangles in an operand take seconds.
constexpr std::size_t most_triangles = 4000;

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

/// Closed shells on the grid, which may touch and overlap; empty when one does not close. What shares no vertex is kept
/// apart before points that coincide are joined.
std::vector<Solid> closed_shells(const Solid& solid, double grid_m) {
  std::vector<Solid> parts = shells(shells_turned_outward(solid));
  if (!std::all_of(parts.begin(), parts.end(), is_closed)) {
    const std::optional<Solid> closed = repaired(solid, grid_m);
    return closed ? shells(*closed) : std::vector<Solid>{};
  }
  for (Solid& part : parts) {
    const bool hollow = volume(part) < 0.0;
    std::optional<Solid> closed = repaired(part, grid_m);
    if (!closed) return {};
    part = std::move(*closed);
    if (hollow)
      for (Eigen::Vector3i& t : part.triangles) std::swap(t[1], t[2]);
  }
  return parts;
}

/// The smallest outward shell around a hollow; shells are given by their volumes.
int owner_of(const Solid& hollow, const std::vector<Solid>& parts, const std::vector<double>& volumes) {
  int owner = -1;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (volumes[i] <= 0.0 || (owner >= 0 && volumes[i] >= volumes[static_cast<std::size_t>(owner)])) continue;
    if (encloses(parts[i], hollow)) owner = static_cast<int>(i);
  }
  return owner;
}

/// The solid as the union of its outward shells, each less the hollows in it: so what lies in a hollow stays.
std::optional<Nef> to_nef(const Solid& solid, double grid_m) {
  const std::vector<Solid> parts = closed_shells(solid, grid_m);
  std::size_t triangles = 0;
  std::vector<double> volumes;
  std::vector<std::optional<Nef>> bounded(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    triangles += parts[i].triangles.size();
    if (triangles > most_triangles || runs_through_itself(parts[i])) return std::nullopt;
    volumes.push_back(volume(parts[i]));
    if (volumes[i] == 0.0) continue;
    bounded[i] = shell_to_nef(turned_outward(parts[i]));
    if (!bounded[i]) return std::nullopt;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (volumes[i] >= 0.0) continue;
    if (const int owner = owner_of(parts[i], parts, volumes); owner >= 0)
      *bounded[static_cast<std::size_t>(owner)] -= *bounded[i];
  }
  std::optional<Nef> all;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (volumes[i] > 0.0) all = all ? *all + *bounded[i] : *bounded[i];
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
    if (steps.empty()) *rest = rest->regularization();
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
