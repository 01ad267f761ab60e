// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

class IfcObjectPlacement;

namespace plumbline::bim {

/// Pose of a product in W, or why there is none.
struct ProductPose {
  std::optional<Eigen::Affine3d> X_WP;  ///< m
  std::string fault;  ///< what makes no sense: an axis has no direction, a coordinate is missing or not a number
};

/// Follows the chain of local and grid placements; identity without a placement. No pose, though there is no fault,
/// where a grid has no intersection that can be found.
[[nodiscard]] ProductPose placement(const std::shared_ptr<IfcObjectPlacement>& object_placement, double unit_m);

}  // namespace plumbline::bim
