// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenarios/metrics/localization_score.h"
#include "scenarios/run/run_files.h"

namespace plumbline::scenarios::score {

/// What the plan allows to be known on this run: start, route and prior as in its scenario. Knows no seed of an
/// estimator and no method. Absent when the run has no pose.
[[nodiscard]] std::optional<Identifiability> identifiability_of(const RunFiles& files, const Truth& truth);

}  // namespace plumbline::scenarios::score
