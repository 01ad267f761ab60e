// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// The corners of a profile in its plane, once around; nullopt for profiles that are not all straight. Rectangles,
/// I-shapes without their roundings, closed polylines, and profiles derived from these.
[[nodiscard]] std::optional<std::vector<Eigen::Vector2d>> straight_profile(const StepEntities& entities,
                                                                           const StepValue& profile);

/// An IfcAxis2Placement3D; identity for none.
[[nodiscard]] Eigen::Affine3d frame_at(const StepEntities& entities, const StepValue& placement);

/// A body between two outlines with as many corners, in the file's units.
struct TaperedBody {
  std::vector<Eigen::Vector3d> start, end;
};

/// What an IfcExtrudedAreaSolidTapered is [iso2018]: straight edges from each corner of its profile to that of its end
/// profile. Nullopt where either is bent or they differ in corners.
[[nodiscard]] std::optional<TaperedBody> tapered_body(const StepEntities& entities, const StepValue& attributes);

}  // namespace plumbline::bim
