// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// What a run cost as a whole.
struct RunCost {
  double total_s = 0.0;  ///< wall clock, from the start of the program
  double cpu_s = 0.0;    ///< of all threads
  double simulated_s = 0.0;
  int threads = 1;
};

/// timings.json: the only file of a run that is not the same every time.
[[nodiscard]] std::string write_timings(const std::vector<StageTimes>& simulation,
                                        const std::vector<MethodRecord>& methods, const RunCost& cost);

}  // namespace plumbline::scenarios
