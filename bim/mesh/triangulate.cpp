// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <deque>

#include "bim/errors.h"

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
  for (std::size_t i = 0; i < handles.size(); ++i)
    triangulation.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
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

FlatMesh inside_faces(Triangulation& triangulation) {
  FlatMesh mesh;
  for (auto vertex : triangulation.finite_vertex_handles()) {
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

}  // namespace

FlatMesh triangulate(const Region2& region) {
  Triangulation triangulation;
  try {
    for (const PolygonWithHoles2& piece : region) {
      insert_ring(triangulation, piece.outer);
      for (const Polygon2& hole : piece.holes) insert_ring(triangulation, hole);
    }
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    throw InternalError("rings of a region cross each other");
  }
  if (triangulation.dimension() < 2) return {};
  mark_levels(triangulation);
  return inside_faces(triangulation);
}

}  // namespace plumbline::bim
