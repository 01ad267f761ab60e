// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenarios/metrics/localization_score.h"
#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios::score {

/// What can be known of the pose in this run, by the building alone and with the furniture as planned: start, route and
/// prior as in its scenario. It depends on no estimator and on no seed of one. Absent when the run has no pose,
/// and for a plan without a place where a robot can stand, which is no evidence that the pose is unique.
[[nodiscard]] std::optional<Identifiability> identifiability_of(const FinishedRun& run, const Truth& truth);

}  // namespace plumbline::scenarios::score
