// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/metrics/metrics.h"
#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios::score {

/// Everything scored of one run.
struct RunScore {
  Truth truth;
  std::vector<MethodScore> methods;  ///< index as in RunRecord::methods
  std::vector<GateResult> gates;
  std::optional<Identifiability> identifiability;  ///< where a method localizes
  double duration_s = 0.0;
  double distance_m = 0.0;
  std::string digest;  ///< of all stages, 16 hex digits

  [[nodiscard]] bool passed() const;
};

/// What a localization reported, with the poses given for it. An outside trajectory in W claims to know where it is
/// from its first pose to the end of the run, also where it has none.
[[nodiscard]] std::vector<Belief> beliefs_of(const MethodRecord& method, const Truth& truth);

/// Scores every method of a run directory, docs/reference/metrics.md. Outside estimates (those the scenario did not
/// run) are held to the strictest bound that the scenario asks of any estimator on each metric that an estimate of
/// their kind has.
[[nodiscard]] RunScore score_run(const FinishedRun& run);

/// results.json
[[nodiscard]] std::string write_results(const FinishedRun& run, const RunScore& score);
/// Writes results.json and junit.xml into `dir`.
void write_scores(const std::string& dir, const FinishedRun& run, const RunScore& score);

}  // namespace plumbline::scenarios::score
