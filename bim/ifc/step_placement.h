// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

class IfcObjectPlacement;

namespace plumbline::bim {

/// Pose of a product in W from its chain of local placements, m. Identity without a placement; nullopt where an axis
/// has no direction or a coordinate is missing or not a number.
[[nodiscard]] std::optional<Eigen::Affine3d> placement(const std::shared_ptr<IfcObjectPlacement>& object_placement,
                                                       double unit_m);

}  // namespace plumbline::bim
