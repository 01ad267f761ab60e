// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "scenarios/run/method_runner.h"
#include "scenarios/run/oracle_method.h"
#include "scenarios/run/record.h"
#include "scenarios/spec/resolve.h"
#include "sim/world.h"

namespace plumbline::scenarios {

struct RunOptions {
  int threads = 1;
  bool methods = true;                                  ///< false: simulate only
  std::optional<double> until_s;                        ///< stop after this simulated time
  std::function<void(double simulated_s)> tick;         ///< called after each scan, for the progress line; may be empty
  std::function<void(const sim::WorldFrame&)> observe;  ///< given each frame, to record it; may be empty
};

/// The methods that a scenario asks for. Estimators get sensor frames alone; the oracle alone gets the truth.
struct RunMethods {
  std::vector<std::unique_ptr<MethodRunner>> estimators;
  std::optional<OracleMethod> oracle;

  /// The records of all methods, in the order of the scenario. `estimated`: those of the estimators.
  [[nodiscard]] std::vector<MethodRecord> finish(const Scenario& scenario, std::vector<MethodRecord> estimated);
};
[[nodiscard]] RunMethods make_methods(const ResolvedScenario& resolved);

/// Simulates the scenario once and feeds every method it asks for. The same scenario gives the same record, apart
/// from the times, at any number of threads. A fall or stall ends the run early and stands in RunRecord::failure.
/// Throws Interrupted; EnvironmentError and InternalError of the simulation.
[[nodiscard]] RunRecord execute(const ResolvedScenario& resolved, const RunOptions& options);

}  // namespace plumbline::scenarios
