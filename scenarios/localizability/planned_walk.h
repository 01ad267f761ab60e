// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/localizability/floor.h"
#include "scenarios/localizability/localizability.h"
#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {

/// The walk a scenario plans, as its robot would make it at best: at its speed along the waypoints, turning in place at
/// sharp corners, until its duration is over or it is kidnapped. Nothing is simulated.
[[nodiscard]] std::vector<TruthSample> planned_walk(const ResolvedScenario& resolved);
/// The walk from where it is set down, its time counted from there; empty where it is not kidnapped.
[[nodiscard]] std::vector<TruthSample> planned_walk_after(const ResolvedScenario& resolved);

/// Localizability along one seed's walk, with the heading unknown and with a compass.
struct WalkAnswers {
  std::uint64_t seed = 0;
  double length_m = 0.0;  ///< until it is kidnapped, where it is
  RunIdentifiability unknown;
  RunIdentifiability compass;
  /// From where it is set down; the heading known at the start is of no use there. Absent where it is not kidnapped.
  std::optional<RunIdentifiability> set_down;
};

/// The same by the building alone and with the furniture as planned.
struct SeedAnswers {
  WalkAnswers building;
  std::optional<WalkAnswers> with_furniture;  ///< absent as in Identifiability
};

/// The answers of the seeds 1 to `seeds` of a scenario file.
[[nodiscard]] std::vector<SeedAnswers> localizability_of_walks(const std::string& scenario, int seeds, int threads);

/// How many walks end with one place left, at once or later, and when.
struct WalkSummary {
  int walks = 0;
  int identifiable = 0;
  int at_once = 0;
  double median_at_s = 0.0;  ///< of the identifiable ones, those at once included
  double median_at_m = 0.0;
};
enum class WalkPart { unknown, compass, set_down };
[[nodiscard]] WalkSummary summary_of(const std::vector<SeedAnswers>& walks, WalkPart part,
                                     PlanEvidence by = PlanEvidence::building);

/// A table an answer.
[[nodiscard]] std::string walks_text(const std::vector<SeedAnswers>& walks);
/// {walks: [{seed, length_m, unknown, compass, set_down}]} by the building alone; with_furniture has the last three
/// again where they differ.
[[nodiscard]] Tree walks_json(const std::vector<SeedAnswers>& walks);

}  // namespace plumbline::scenarios
