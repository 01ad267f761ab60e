// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

class IfcGridPlacement;
class IfcObjectPlacement;

namespace plumbline::bim {

/// A product's pose in a grid.
struct GridPose {
  Eigen::Affine3d X_GP = Eigen::Affine3d::Identity();  ///< m
  std::shared_ptr<IfcObjectPlacement> grid;            ///< where the grid stands; null in W
};

/// The intersection of two axes of a grid, each moved to its left by its offset, at the height of the third offset; x
/// along the reference direction, towards the reference intersection, or along the first axis; z is the grid's
/// [iso2018, IfcGridPlacement]. Nullopt where an axis is no straight line, axes are parallel
/// or something is missing.
[[nodiscard]] std::optional<GridPose> grid_pose(const IfcGridPlacement& placement, double unit_m);

}  // namespace plumbline::bim
