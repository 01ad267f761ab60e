// SPDX-License-Identifier: Apache-2.0
#include "bim/ifc/step_placement.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#include <ifcpp/IFC4/include/IfcAxis2Placement2D.h>
#include <ifcpp/IFC4/include/IfcAxis2Placement3D.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcDirection.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcLocalPlacement.h>
#include <ifcpp/IFC4/include/IfcReal.h>
#pragma GCC diagnostic pop

namespace plumbline::bim {
namespace {

/// Two or three numbers as a vector, the third 0 when absent.
template <class Measures>
std::optional<Eigen::Vector3d> vector_of(const Measures& measures) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (measures.size() < 2 || measures.size() > 3) return std::nullopt;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (!measures[i]) return std::nullopt;
    v[static_cast<Eigen::Index>(i)] = measures[i]->m_value;
  }
  return v.allFinite() ? std::optional(v) : std::nullopt;
}

std::optional<Eigen::Vector3d> direction_of(const std::shared_ptr<IfcDirection>& direction,
                                            const Eigen::Vector3d& standard) {
  if (!direction) return standard;
  return vector_of(direction->m_DirectionRatios);
}

/// z along Axis, x the part of RefDirection across it, y completing them.
std::optional<Eigen::Affine3d> frame(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                                     const Eigen::Vector3d& reference) {
  constexpr double least_sine = 1e-9;
  const Eigen::Vector3d y = axis.cross(reference);
  if (!(y.norm() > least_sine * axis.norm() * reference.norm()) || axis.isZero(0.0)) return std::nullopt;
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.linear().col(1) = y.normalized();
  X.linear().col(2) = axis.normalized();
  X.linear().col(0) = X.linear().col(1).cross(X.linear().col(2));
  X.translation() = origin;
  return X;
}

std::optional<Eigen::Affine3d> relative(const std::shared_ptr<IfcAxis2Placement>& select, double unit_m) {
  const auto placement = std::dynamic_pointer_cast<IfcPlacement>(select);
  if (!placement || !placement->m_Location) return std::nullopt;
  const auto origin = vector_of(placement->m_Location->m_Coordinates);
  std::optional<Eigen::Vector3d> axis = Eigen::Vector3d::UnitZ(), reference;
  if (const auto in_space = std::dynamic_pointer_cast<IfcAxis2Placement3D>(select)) {
    axis = direction_of(in_space->m_Axis, Eigen::Vector3d::UnitZ());
    if (!axis) return std::nullopt;
    // Without a reference the x axis is the part of the file's x axis across z [ISO 10303-42 first_proj_axis].
    const bool along_x = axis->cross(Eigen::Vector3d::UnitX()).norm() <= 1e-9 * axis->norm();
    reference = direction_of(in_space->m_RefDirection, along_x ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
  } else if (const auto in_plane = std::dynamic_pointer_cast<IfcAxis2Placement2D>(select)) {
    reference = direction_of(in_plane->m_RefDirection, Eigen::Vector3d::UnitX());
  }
  if (!origin || !axis || !reference) return std::nullopt;
  return frame(*origin * unit_m, *axis, *reference);
}

}  // namespace

std::optional<Eigen::Affine3d> placement(const std::shared_ptr<IfcObjectPlacement>& object_placement, double unit_m) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  // The chain has an end: references in circles do not get past check_step_text().
  for (auto at = object_placement; at;) {
    const auto local = std::dynamic_pointer_cast<IfcLocalPlacement>(at);
    if (!local) return std::nullopt;
    const std::optional<Eigen::Affine3d> step = relative(local->m_RelativePlacement, unit_m);
    if (!step) return std::nullopt;
    X = *step * X;
    at = local->m_PlacementRelTo;
  }
  return X;
}

}  // namespace plumbline::bim
