// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// Points of an IfcBSplineCurveWithKnots, rational or not, nine a span. Empty where its knots make no sense.
[[nodiscard]] std::vector<Eigen::Vector3d> spline_points(const StepEntities& entities,
                                                         const StepEntities::Entity& spline);

}  // namespace plumbline::bim
