// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/plan/plan.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/run/run_files.h"

namespace plumbline::scenarios::score {

/// Everything scored of one run, from what is on disk.
struct RunScore {
  bim::Plan as_built;
  Truth truth;
  std::vector<MethodScore> methods;  ///< index as in RunFiles::methods
  std::vector<GateResult> gates;
  std::optional<Identifiability> identifiability;  ///< where a method localizes
  double duration_s = 0.0;
  double distance_m = 0.0;
  std::string digest;  ///< of all stages, 16 hex digits

  [[nodiscard]] bool passed() const;
};

/// Scores every method of a run directory [contract: Metrics]. Outside estimates (those the scenario did not run) are
/// held to the strictest bound that the scenario asks of any estimator on each metric that an estimate of their kind
/// has.
[[nodiscard]] RunScore score_run(const RunFiles& files);

/// results.json
[[nodiscard]] std::string write_results(const RunFiles& files, const RunScore& score);
/// Writes results.json and junit.xml into files.dir.
void write_scores(const RunFiles& files, const RunScore& score);

}  // namespace plumbline::scenarios::score
