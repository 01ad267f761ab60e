// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/run/record.h"
#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {

/// A run that has ended: what scores and the report are made of. It is the same, bit for bit, whether the run has just
/// ended (finished_run) or is read from its directory (read_run).
struct FinishedRun {
  Scenario scenario;
  std::shared_ptr<const RunBuilding> building;
  WalkCoverage walk;                     ///< as planned
  std::vector<slam::Nanoseconds> scans;  ///< stamps of all scans
  RunRecord record;                      ///< methods: the scenario's in its order, then outside estimates by name
  std::vector<std::string> altered;      ///< files that are not as the run wrote them, and were taken all the same
};

/// Stamps of the scans in a log.
[[nodiscard]] std::vector<slam::Nanoseconds> scans_of(const DigestLog& log);

/// A run that has just ended, with the precision that its files keep.
[[nodiscard]] FinishedRun finished_run(const ResolvedScenario& resolved, RunRecord record);

}  // namespace plumbline::scenarios
