// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_facets.h"

#include <ifcpp/IFC4/include/IfcCartesianPointList3D.h>
#include <ifcpp/IFC4/include/IfcClosedShell.h>
#include <ifcpp/IFC4/include/IfcConnectedFaceSet.h>
#include <ifcpp/IFC4/include/IfcEdgeLoop.h>
#include <ifcpp/IFC4/include/IfcFace.h>
#include <ifcpp/IFC4/include/IfcFaceBasedSurfaceModel.h>
#include <ifcpp/IFC4/include/IfcFaceBound.h>
#include <ifcpp/IFC4/include/IfcFaceSurface.h>
#include <ifcpp/IFC4/include/IfcIndexedPolygonalFaceWithVoids.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcManifoldSolidBrep.h>
#include <ifcpp/IFC4/include/IfcPolygonalFaceSet.h>
#include <ifcpp/IFC4/include/IfcPositiveInteger.h>
#include <ifcpp/IFC4/include/IfcShell.h>
#include <ifcpp/IFC4/include/IfcShellBasedSurfaceModel.h>
#include <ifcpp/IFC4/include/IfcSurface.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace plumbline::bim {
namespace {

using Indices = std::vector<std::shared_ptr<IfcPositiveInteger>>;

/// Indices from 1 into the points, by way of those of the face set where it has such, from 0; nullopt where one of them
/// is beyond the end.
std::optional<std::vector<int>> loop_of(const Indices& indices, const Indices& by_way, std::size_t points) {
  const auto within = [](const std::shared_ptr<IfcPositiveInteger>& index, std::size_t end) {
    return index && index->m_value >= 1 && static_cast<std::size_t>(index->m_value) <= end;
  };
  std::vector<int> loop;
  for (const auto& index : indices) {
    if (!within(index, by_way.empty() ? points : by_way.size())) return std::nullopt;
    const auto& found = by_way.empty() ? index : by_way[static_cast<std::size_t>(index->m_value - 1)];
    if (!within(found, points)) return std::nullopt;
    loop.push_back(found->m_value - 1);
  }
  return loop.size() < 3 ? std::nullopt : std::optional(loop);
}

bool has_edges(const IfcFace& face) {
  return std::any_of(face.m_Bounds.begin(), face.m_Bounds.end(),
                     [](const auto& bound) { return bound && std::dynamic_pointer_cast<IfcEdgeLoop>(bound->m_Bound); });
}

bool is_curved(const IfcFace& face) {
  const auto* on_surface = dynamic_cast<const IfcFaceSurface*>(&face);
  return on_surface != nullptr && on_surface->m_FaceSurface &&
         std::string_view(on_surface->m_FaceSurface->className()) != "IfcPlane";
}

void count(const IfcConnectedFaceSet& faces, OddFaces& odd) {
  for (const auto& face : faces.m_CfsFaces) {
    if (!face) continue;
    if (has_edges(*face))
      ++odd.unread;
    else if (is_curved(*face))
      ++odd.curved;
  }
}

}  // namespace

Facets polygonal_facets(const IfcPolygonalFaceSet& set, double unit_m, std::vector<std::string>& problems) {
  Facets facets;
  if (!set.m_Coordinates) return facets;
  for (const auto& point : set.m_Coordinates->m_CoordList) {
    if (point.size() != 3 || !point[0] || !point[1] || !point[2]) return facets;
    facets.points.emplace_back(point[0]->m_value, point[1]->m_value, point[2]->m_value);
    facets.points.back() *= unit_m;
  }
  int lost = 0, filled = 0;
  for (const auto& face : set.m_Faces) {
    const auto outline =
        face ? loop_of(face->m_CoordIndex, set.m_PnIndex, facets.points.size()) : std::optional<std::vector<int>>();
    if (!outline) {
      ++lost;
      continue;
    }
    std::vector<std::vector<int>> loops = {*outline};
    if (const auto* with_voids = dynamic_cast<const IfcIndexedPolygonalFaceWithVoids*>(face.get()))
      for (const Indices& inner : with_voids->m_InnerCoordIndices)
        if (auto hole = loop_of(inner, set.m_PnIndex, facets.points.size())) loops.push_back(std::move(*hole));
    if (loops.size() > 1 && add_triangles(facets, loops)) continue;
    filled += loops.size() > 1 ? 1 : 0;
    facets.loops.push_back(loops.front());
  }
  if (lost > 0)
    problems.push_back(std::to_string(lost) + " faces point to vertices that are not there, and are left out");
  if (filled > 0)
    problems.push_back(std::to_string(filled) + " faces have holes that cross their outline; it is filled");
  return facets;
}

OddFaces odd_faces(const IfcRepresentationItem& item) {
  OddFaces odd;
  if (const auto* brep = dynamic_cast<const IfcManifoldSolidBrep*>(&item); brep != nullptr && brep->m_Outer)
    count(*brep->m_Outer, odd);
  if (const auto* model = dynamic_cast<const IfcShellBasedSurfaceModel*>(&item))
    for (const auto& shell : model->m_SbsmBoundary)
      if (const auto faces = std::dynamic_pointer_cast<IfcConnectedFaceSet>(shell)) count(*faces, odd);
  if (const auto* model = dynamic_cast<const IfcFaceBasedSurfaceModel*>(&item))
    for (const auto& faces : model->m_FbsmFaces)
      if (faces) count(*faces, odd);
  return odd;
}

}  // namespace plumbline::bim
