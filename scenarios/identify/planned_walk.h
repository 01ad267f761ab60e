// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/identify/identify.h"
#include "scenarios/resolve.h"

namespace plumbline::scenarios {

/// The walk a scenario plans, as its robot would make it at best: at its speed along the waypoints, turning in place at
/// sharp corners, until its duration is over. Nothing is simulated.
[[nodiscard]] std::vector<TruthSample> planned_walk(const ResolvedScenario& resolved);

/// What one seed's walk lets be known, with the heading unknown and with a compass.
struct WalkAnswers {
  std::uint64_t seed = 0;
  double length_m = 0.0;
  RunIdentifiability unknown;
  RunIdentifiability compass;
};

/// The answers of the seeds 1 to `seeds` of a scenario file.
[[nodiscard]] std::vector<WalkAnswers> identify_walks(const std::string& scenario, int seeds, int threads);

/// How many walks end with one place left, at once or later, and when.
struct WalkSummary {
  int walks = 0;
  int identifiable = 0;
  int at_once = 0;
  double median_at_s = 0.0;  ///< of the identifiable ones, those at once included
  double median_at_m = 0.0;
};
[[nodiscard]] WalkSummary summary_of(const std::vector<WalkAnswers>& walks, bool compass);

[[nodiscard]] std::string walks_text(const std::vector<WalkAnswers>& walks);
[[nodiscard]] Tree walks_json(const std::vector<WalkAnswers>& walks);

}  // namespace plumbline::scenarios
