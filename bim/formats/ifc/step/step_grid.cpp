// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_grid.h"

#include <ifcpp/IFC4/include/IfcBoolean.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcCurve.h>
#include <ifcpp/IFC4/include/IfcDirection.h>
#include <ifcpp/IFC4/include/IfcGrid.h>
#include <ifcpp/IFC4/include/IfcGridAxis.h>
#include <ifcpp/IFC4/include/IfcGridPlacement.h>
#include <ifcpp/IFC4/include/IfcGridPlacementDirectionSelect.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcLine.h>
#include <ifcpp/IFC4/include/IfcPolyline.h>
#include <ifcpp/IFC4/include/IfcReal.h>
#include <ifcpp/IFC4/include/IfcTrimmedCurve.h>
#include <ifcpp/IFC4/include/IfcVector.h>
#include <ifcpp/IFC4/include/IfcVirtualGridIntersection.h>

#include <cmath>

#include "bim/formats/ifc/step/step_vector.h"

namespace plumbline::bim {
namespace {

constexpr double least_sine = 1e-6;  // axes closer to parallel meet nowhere that could be meant

/// A straight line in the plane of a grid, m.
struct GridLine {
  Eigen::Vector2d at, along;  ///< along has length 1
};

std::optional<GridLine> line_through(const std::optional<Eigen::Vector3d>& at,
                                     const std::optional<Eigen::Vector3d>& along, double unit_m) {
  if (!at || !along || !(along->head<2>().norm() > 0.0)) return std::nullopt;
  return GridLine{at->head<2>() * unit_m, along->head<2>().normalized()};
}

/// The line of a polyline all of whose points lie on it.
std::optional<GridLine> line_of(const IfcPolyline& polyline, double unit_m) {
  std::optional<GridLine> line;
  const auto& points = polyline.m_Points;
  if (points.size() < 2 || !points.front() || !points.back()) return std::nullopt;
  const auto first = vector_of(points.front()->m_Coordinates), last = vector_of(points.back()->m_Coordinates);
  if (!first || !last) return std::nullopt;
  line = line_through(first, *last - *first, unit_m);
  for (const auto& point : points) {
    const auto p = point ? vector_of(point->m_Coordinates) : std::nullopt;
    if (!line || !p) return std::nullopt;
    const Eigen::Vector2d v = p->head<2>() * unit_m - line->at;
    if (std::abs(line->along.x() * v.y() - line->along.y() * v.x()) > least_sine * (1.0 + v.norm()))
      return std::nullopt;
  }
  return line;
}

std::optional<GridLine> line_of(const std::shared_ptr<IfcCurve>& curve, double unit_m) {
  if (const auto polyline = std::dynamic_pointer_cast<IfcPolyline>(curve)) return line_of(*polyline, unit_m);
  if (const auto trimmed = std::dynamic_pointer_cast<IfcTrimmedCurve>(curve)) {
    std::optional<GridLine> line = line_of(trimmed->m_BasisCurve, unit_m);
    if (line && trimmed->m_SenseAgreement && !trimmed->m_SenseAgreement->m_value) line->along = -line->along;
    return line;
  }
  const auto line = std::dynamic_pointer_cast<IfcLine>(curve);
  if (!line || !line->m_Pnt || !line->m_Dir || !line->m_Dir->m_Orientation) return std::nullopt;
  return line_through(vector_of(line->m_Pnt->m_Coordinates), vector_of(line->m_Dir->m_Orientation->m_DirectionRatios),
                      unit_m);
}

std::optional<GridLine> line_of(const std::shared_ptr<IfcGridAxis>& axis, double unit_m) {
  if (!axis) return std::nullopt;
  std::optional<GridLine> line = line_of(axis->m_AxisCurve, unit_m);
  if (line && axis->m_SameSense && !axis->m_SameSense->m_value) line->along = -line->along;
  return line;
}

/// Where two axes meet, and the direction of the first.
struct Crossing {
  Eigen::Vector3d at;
  Eigen::Vector2d along;
};

std::optional<Crossing> crossing(const std::shared_ptr<IfcVirtualGridIntersection>& source, double unit_m) {
  if (!source || source->m_IntersectingAxes.size() != 2) return std::nullopt;
  const auto offsets = vector_of(source->m_OffsetDistances);
  std::optional<GridLine> first = line_of(source->m_IntersectingAxes[0], unit_m);
  std::optional<GridLine> second = line_of(source->m_IntersectingAxes[1], unit_m);
  if (!offsets || !first || !second) return std::nullopt;
  const auto move_left = [&](GridLine& line, double offset) {
    line.at += offset * unit_m * Eigen::Vector2d(-line.along.y(), line.along.x());
  };
  move_left(*first, offsets->x());
  move_left(*second, offsets->y());
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); };
  const double sine = cross(first->along, second->along);
  if (std::abs(sine) < least_sine) return std::nullopt;
  const Eigen::Vector2d at = first->at + cross(second->at - first->at, second->along) / sine * first->along;
  return Crossing{{at.x(), at.y(), offsets->z() * unit_m}, first->along};
}

/// The grid that an axis belongs to.
std::shared_ptr<IfcGrid> grid_of(const IfcGridAxis& axis) {
  for (const auto* grids : {&axis.m_PartOfU_inverse, &axis.m_PartOfV_inverse, &axis.m_PartOfW_inverse})
    for (const auto& link : *grids)
      if (auto grid = link.lock()) return grid;
  return nullptr;
}

/// Direction of x in the plane of the grid; nullopt where it has none.
std::optional<Eigen::Vector2d> reference(const IfcGridPlacement& placement, const Crossing& origin, double unit_m) {
  const auto& select = placement.m_PlacementRefDirection;
  if (!select) return origin.along;
  std::optional<Eigen::Vector3d> v;
  if (const auto direction = std::dynamic_pointer_cast<IfcDirection>(select)) {
    v = vector_of(direction->m_DirectionRatios);
  } else if (const auto other = crossing(std::dynamic_pointer_cast<IfcVirtualGridIntersection>(select), unit_m)) {
    v = other->at - origin.at;
  }
  if (!v || !(v->head<2>().norm() > least_sine * v->norm())) return std::nullopt;
  return v->head<2>().normalized();
}

}  // namespace

std::optional<GridPose> grid_pose(const IfcGridPlacement& placement, double unit_m) {
  const std::optional<Crossing> origin = crossing(placement.m_PlacementLocation, unit_m);
  if (!origin) return std::nullopt;
  const std::optional<Eigen::Vector2d> x = reference(placement, *origin, unit_m);
  const auto grid = grid_of(*placement.m_PlacementLocation->m_IntersectingAxes.front());
  if (!x || !grid) return std::nullopt;
  GridPose pose;
  pose.X_GP.linear().col(0) = Eigen::Vector3d(x->x(), x->y(), 0.0);
  pose.X_GP.linear().col(1) = Eigen::Vector3d(-x->y(), x->x(), 0.0);
  pose.X_GP.translation() = origin->at;
  pose.grid = grid->m_ObjectPlacement;
  return pose;
}

}  // namespace plumbline::bim
