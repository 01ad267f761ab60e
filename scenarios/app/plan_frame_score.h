// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/metrics/metrics.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// Scores an estimate of a localization by true poses in the plan's frame W, at the scans that lie within them; nothing
/// is aligned. Without what the building allows to be known: a localization that is undecided is late. positions_alone:
/// the reference tells no orientation. Throws InputError, naming `file`, where no scan lies within the reference.
[[nodiscard]] score::MethodScore score_in_plan_frame(const MethodRecord& method,
                                                     const std::vector<slam::StampedPose>& reference_W,
                                                     bool positions_alone, const std::string& file);

/// One line for a terminal.
[[nodiscard]] std::string words_of(const score::MethodScore& in_plan_frame);

}  // namespace plumbline::scenarios
