// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/metrics/metrics.h"
#include "scenarios/run/record.h"

namespace plumbline::scenarios {

struct PlanFrameScore {
  score::MethodScore score;
  double judged_share = 0.0;  ///< of the scans
};

/// Scores an estimate of a localization by true poses in the plan's frame W, at the scans that lie between two of them
/// that follow one another; nothing is aligned. Where the reference pauses, no scan is judged. Without what the
/// building allows to be known: a localization that is undecided is late. positions_alone: the reference tells no
/// orientation. Throws InputError, naming `file`, where no scan lies within the reference.
[[nodiscard]] PlanFrameScore score_in_plan_frame(const MethodRecord& method,
                                                 const std::vector<slam::StampedPose>& reference_W,
                                                 bool positions_alone, const std::string& file);

/// One line for a terminal.
[[nodiscard]] std::string words_of(const PlanFrameScore& in_plan_frame);

}  // namespace plumbline::scenarios
