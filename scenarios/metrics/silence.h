// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/metrics/reference_score.h"

namespace plumbline::scenarios::score {

/// Stamps of the first and the last of a row of scans after which a method said that it is lost.
struct LostSpan {
  slam::Nanoseconds from = 0;
  slam::Nanoseconds to = 0;
};

/// Rules of how a method's word is compared with its error.
struct SilenceRules {
  double most_error_m = 1.0;  ///< beyond it a method should say that it is lost
  ReferenceRules reference;
};

/// Whether a method says so when it is lost.
struct Silence {
  double silent_s = 0.0;           ///< longest time with a greater error, without a word of it
  std::optional<double> off_at_s;  ///< when the error was first greater, after the first pose; absent if it never was
  std::optional<double> said_after_s;  ///< from then until it was said; 0 if it was already, absent if it never was
};

/// Errors are those of the causal positions, placed by the first pose: what a user of the running method sees. A best
/// alignment would spread a late error over the walk, to where the method was right. The state after a scan holds
/// until the next one. `lost` must be in time order. Absent where no pose has a true one.
[[nodiscard]] std::optional<Silence> score_silence(const std::vector<slam::StampedPose>& reference_W,
                                                   const std::vector<slam::StampedPose>& causal_F,
                                                   const std::vector<LostSpan>& lost, const SilenceRules& rules = {});

}  // namespace plumbline::scenarios::score
