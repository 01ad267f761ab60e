// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/metrics/localization_score.h"

namespace plumbline::scenarios::score {

/// A failure and the scan at which it happened.
struct FailureAt {
  Failure failure = Failure::undecided;
  slam::Nanoseconds stamp = 0;
};

/// Why a run failed; nothing where its verdict is success, honest_ambiguity or lucky. The true pose counts as sampled
/// while a hypothesis or a kept particle lies within 0.5 m and 15 degrees of it; particles are a sample of at most 500,
/// one scan a second, so that a depletion may be reported up to a second late.
[[nodiscard]] std::optional<FailureAt> failure_of(const Truth& truth, const std::vector<Belief>& beliefs,
                                                  LocalizationVerdict verdict,
                                                  const std::vector<Pose>& aliases_at_start,
                                                  const LocalizationRules& rules);

}  // namespace plumbline::scenarios::score
