// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_placement.h"

#include <ifcpp/IFC4/include/IfcAxis2Placement2D.h>
#include <ifcpp/IFC4/include/IfcAxis2Placement3D.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcDirection.h>
#include <ifcpp/IFC4/include/IfcGridPlacement.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcLocalPlacement.h>
#include <ifcpp/IFC4/include/IfcReal.h>

#include "bim/formats/ifc/step/step_grid.h"
#include "bim/formats/ifc/step/step_vector.h"

namespace plumbline::bim {
namespace {

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
    // Without a reference the x axis is the part of the file's x axis across z [iso2021, first_proj_axis].
    const bool along_x = axis->cross(Eigen::Vector3d::UnitX()).norm() <= 1e-9 * axis->norm();
    reference = direction_of(in_space->m_RefDirection, along_x ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
  } else if (const auto in_plane = std::dynamic_pointer_cast<IfcAxis2Placement2D>(select)) {
    reference = direction_of(in_plane->m_RefDirection, Eigen::Vector3d::UnitX());
  }
  if (!origin || !axis || !reference) return std::nullopt;
  return frame(*origin * unit_m, *axis, *reference);
}

}  // namespace

ProductPose placement(const std::shared_ptr<IfcObjectPlacement>& object_placement, double unit_m) {
  // References in circles do not get past check_step_text(), but a grid may stand on itself: its axes know it by an
  // inverse relation.
  constexpr int most_steps = 1000;
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  auto at = object_placement;
  for (int step = 0; at; ++step) {
    if (step == most_steps) return {};
    if (const auto on_grid = std::dynamic_pointer_cast<IfcGridPlacement>(at)) {
      const std::optional<GridPose> pose = grid_pose(*on_grid, unit_m);
      if (!pose) return {};
      X = pose->X_GP * X;
      at = pose->grid;
      continue;
    }
    const auto local = std::dynamic_pointer_cast<IfcLocalPlacement>(at);
    if (local && !local->m_RelativePlacement)
      return {std::nullopt,
              "has a placement, #" + std::to_string(local->m_entity_id) + ", without its RelativePlacement"};
    const std::optional<Eigen::Affine3d> in_parent =
        local ? relative(local->m_RelativePlacement, unit_m) : std::nullopt;
    if (!in_parent) return {std::nullopt, "has a placement that makes no sense"};
    X = *in_parent * X;
    at = local->m_PlacementRelTo;
  }
  return {X, ""};
}

}  // namespace plumbline::bim
