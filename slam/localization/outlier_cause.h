// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "slam/localization/compare_hypotheses.h"

namespace plumbline::slam {

/// What explains where a beam ended, other than predicted.
struct ExplainedOutlier {
  OutlierCause cause;
  std::optional<OutlierCause> object;  ///< that is needed besides, where the cause leaves open what the beam ended on
  bool passes_wall = false;            ///< the beam ends beyond the far side of a wall
};
/// predicted, lane: what the plan has for the beam. range: horizontal, m.
[[nodiscard]] ExplainedOutlier explain_outlier(const Structure& structure, const PlanRay& ray, double range,
                                               const PredictedBlock& predicted, std::size_t lane,
                                               const HypothesisComparisonConfig& config);

}  // namespace plumbline::slam
