// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// Points of an IfcBSplineCurveWithKnots, rational or not: nine pieces a span, more where these would
/// cut deeper than `depth`. Empty where its knots make no sense.
[[nodiscard]] std::vector<Eigen::Vector3d> spline_points(const StepEntities& entities,
                                                         const StepEntities::Entity& spline, double depth);

}  // namespace plumbline::bim
