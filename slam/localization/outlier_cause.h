// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "slam/localization/compare_hypotheses.h"

namespace plumbline::slam {

/// The plan is cast no farther than this beyond a return: the residual is at its cap there.
constexpr float cast_beyond_m = 2.0F;

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
