// SPDX-License-Identifier: Apache-2.0
#include "bim/model/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>
#include <utility>

#include "bim/errors.h"
#include "bim/geometry/snap_rounding.h"

namespace plumbline::bim {

namespace {

struct FaceInfo {
  int level = -1;  ///< constrained edges between the face and infinity; odd: inside the region
  int index = -1;  ///< into FlatMesh::triangles, -1 outside
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
using Face = Triangulation::Face_handle;

void insert_ring(Triangulation& triangulation, const Polygon2& ring) {
  std::vector<Triangulation::Vertex_handle> handles;
  for (const Eigen::Vector2d& p : ring) handles.push_back(triangulation.insert(Kernel::Point_2(p.x(), p.y())));
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const auto from = handles[i], to = handles[(i + 1) % handles.size()];
    if (from != to) triangulation.insert_constraint(from, to);  // CGAL does not guard against edges without length
  }
}

/// Floods from infinity: each constrained edge that is crossed raises the level by one.
void mark_levels(Triangulation& triangulation) {
  std::deque<Face> queue = {triangulation.infinite_face()};
  triangulation.infinite_face()->info().level = 0;
  while (!queue.empty()) {
    const Face face = queue.front();
    queue.pop_front();
    for (int i = 0; i < 3; ++i) {
      const Face next = face->neighbor(i);
      if (next->info().level >= 0) continue;
      // Across a constraint comes later: the whole of one level is flooded before the next begins.
      if (face->is_constrained(i)) {
        next->info().level = face->info().level + 1;
        queue.push_back(next);
      } else {
        next->info().level = face->info().level;
        queue.push_front(next);
      }
    }
  }
}

/// Inside faces with points in lexicographic order.
FlatMesh inside_faces(Triangulation& triangulation) {
  std::vector<Triangulation::Vertex_handle> vertices;
  for (const auto vertex : triangulation.finite_vertex_handles()) vertices.push_back(vertex);
  std::sort(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a->point() < b->point(); });
  FlatMesh mesh;
  for (const auto& vertex : vertices) {
    vertex->info() = static_cast<int>(mesh.points.size());
    mesh.points.emplace_back(vertex->point().x(), vertex->point().y());
  }
  std::vector<Face> inside;
  for (const Face face : triangulation.finite_face_handles()) {
    if (face->info().level % 2 == 0) continue;
    face->info().index = static_cast<int>(inside.size());
    inside.push_back(face);
  }
  for (const Face face : inside) {
    FlatTriangle triangle;
    for (int i = 0; i < 3; ++i) {
      triangle.points[static_cast<std::size_t>(i)] = face->vertex(i)->info();
      triangle.neighbours[static_cast<std::size_t>(i)] = face->neighbor(i)->info().index;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

/// The two triangles at an inner edge, seen as a quadrilateral: edge `i` of triangle `t`, edge `j` of triangle `u`.
struct Quad {
  std::size_t t, i, u, j;
};

Quad quad_at(const FlatMesh& mesh, std::size_t t, std::size_t i) {
  const auto u = static_cast<std::size_t>(mesh.triangles[t].neighbours[i]);
  const auto& back = mesh.triangles[u].neighbours;
  const auto j = static_cast<std::size_t>(std::find(back.begin(), back.end(), static_cast<int>(t)) - back.begin());
  return {t, i, u, j};
}

/// On one circle, and the lowest of the four points is not on the common edge.
bool ties_the_wrong_way(const FlatMesh& mesh, const Quad& quad) {
  const auto& t = mesh.triangles[quad.t].points;
  const int p = t[quad.i], q = mesh.triangles[quad.u].points[quad.j];
  if (std::min(p, q) > std::min(t[(quad.i + 1) % 3], t[(quad.i + 2) % 3])) return false;
  const auto point = [&](int k) {
    const Eigen::Vector2d& v = mesh.points[static_cast<std::size_t>(k)];
    return Kernel::Point_2(v.x(), v.y());
  };
  return CGAL::side_of_oriented_circle(point(t[0]), point(t[1]), point(t[2]), point(q)) == CGAL::ON_ORIENTED_BOUNDARY;
}

void replace_neighbour(FlatMesh& mesh, int triangle, std::size_t from, std::size_t to) {
  if (triangle < 0) return;
  auto& neighbours = mesh.triangles[static_cast<std::size_t>(triangle)].neighbours;
  std::replace(neighbours.begin(), neighbours.end(), static_cast<int>(from), static_cast<int>(to));
}

void flip(FlatMesh& mesh, const Quad& quad) {
  const FlatTriangle t = mesh.triangles[quad.t], u = mesh.triangles[quad.u];
  const std::size_t i = quad.i, j = quad.j;
  const int p = t.points[i], a = t.points[(i + 1) % 3], b = t.points[(i + 2) % 3], q = u.points[j];
  const int t_b = t.neighbours[(i + 1) % 3], t_a = t.neighbours[(i + 2) % 3];  // across b-p and across p-a
  const int u_a = u.neighbours[(j + 1) % 3], u_b = u.neighbours[(j + 2) % 3];  // across a-q and across q-b
  const int T = static_cast<int>(quad.t), U = static_cast<int>(quad.u);
  mesh.triangles[quad.t] = {{p, a, q}, {u_a, U, t_a}};
  mesh.triangles[quad.u] = {{p, q, b}, {u_b, t_b, T}};
  replace_neighbour(mesh, u_a, quad.u, quad.t);
  replace_neighbour(mesh, t_b, quad.t, quad.u);
}

/// Points on one circle leave the diagonal open, and CGAL decides by addresses in memory. Here the diagonal goes to
/// the lowest point: the flips end, as each lowers a lifted surface, and the end does not depend on their order.
void settle_ties(FlatMesh& mesh) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (mesh.triangles[t].neighbours[i] < 0) continue;
        const Quad quad = quad_at(mesh, t, i);
        if (!ties_the_wrong_way(mesh, quad)) continue;
        flip(mesh, quad);
        changed = true;
      }
    }
  }
}

FlatTriangle lowest_first(const FlatTriangle& t) {
  const auto k = static_cast<std::size_t>(std::min_element(t.points.begin(), t.points.end()) - t.points.begin());
  return {{t.points[k], t.points[(k + 1) % 3], t.points[(k + 2) % 3]},
          {t.neighbours[k], t.neighbours[(k + 1) % 3], t.neighbours[(k + 2) % 3]}};
}

void sort_triangles(FlatMesh& mesh) {
  for (FlatTriangle& t : mesh.triangles) t = lowest_first(t);
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return mesh.triangles[static_cast<std::size_t>(a)].points < mesh.triangles[static_cast<std::size_t>(b)].points;
  });
  std::vector<int> rank(order.size());
  std::vector<FlatTriangle> sorted;
  for (const int old : order) {
    rank[static_cast<std::size_t>(old)] = static_cast<int>(sorted.size());
    sorted.push_back(mesh.triangles[static_cast<std::size_t>(old)]);
  }
  for (FlatTriangle& t : sorted)
    for (int& neighbour : t.neighbours)
      if (neighbour >= 0) neighbour = rank[static_cast<std::size_t>(neighbour)];
  mesh.triangles = std::move(sorted);
}

/// False when rings cross, or one has a corner within an edge of another.
bool insert(Triangulation& triangulation, const Region2& region) {
  try {
    for (const PolygonWithHoles2& piece : region) {
      insert_ring(triangulation, piece.outer);
      for (const Polygon2& hole : piece.holes) insert_ring(triangulation, hole);
    }
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return false;
  }
  return true;
}

FlatMesh mesh_of(Triangulation& triangulation) {
  if (triangulation.dimension() < 2) return {};
  mark_levels(triangulation);
  FlatMesh mesh = inside_faces(triangulation);
  settle_ties(mesh);
  sort_triangles(mesh);
  return mesh;
}

/// The region with its rings led through the corners of others that lie within their edges, where rings touch. Whether
/// they do is decided in whole steps of the grid: decimals have a last bit. Nullopt where a corner is not on the grid.
std::optional<Region2> led_through_corners(Region2 region) {
  bool on_grid = true;
  const auto each = [&](const auto& change) {
    for (PolygonWithHoles2& piece : region) {
      for (Eigen::Vector2d& p : piece.outer) change(p);
      for (Polygon2& hole : piece.holes)
        for (Eigen::Vector2d& p : hole) change(p);
    }
  };
  each([&](Eigen::Vector2d& p) {
    on_grid = on_grid && p.x() == snap(p.x()) && p.y() == snap(p.y());
    p = {std::round(p.x() / boolean_grid_m), std::round(p.y() / boolean_grid_m)};
  });
  if (!on_grid) return std::nullopt;
  lead_through_corners(region);
  each([](Eigen::Vector2d& p) { p = {snap(p.x() * boolean_grid_m), snap(p.y() * boolean_grid_m)}; });
  return region;
}

}  // namespace

FlatMesh triangulate(const Region2& region) {
  Triangulation triangulation;
  if (insert(triangulation, region)) return mesh_of(triangulation);
  // A corner within an edge counts as a crossing, too.
  const std::optional<Region2> led = led_through_corners(region);
  Triangulation again;
  if (!led || !insert(again, *led)) throw InternalError("rings of a region cross each other");
  return mesh_of(again);
}

}  // namespace plumbline::bim
