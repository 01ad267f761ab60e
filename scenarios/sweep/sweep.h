// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "scenarios/sweep/sweep_file.h"

namespace plumbline::scenarios {

struct SweepOptions {
  std::string out;
  int jobs = 1;
  std::function<void(std::size_t done, std::size_t all)> resumed;   ///< called where runs are there already
  std::function<void(std::size_t done, std::size_t all)> progress;  ///< called after each run; may be empty
};

/// Makes the results that are not there yet, those of one walk in a child process, then the tables from all of them;
/// gives the table as text. Throws InputError where a run refuses its input or another sweep stands in `out`,
/// EnvironmentError, and Interrupted; what is there by then stays.
[[nodiscard]] std::string run_sweep(const Sweep& sweep, const SweepOptions& options);

}  // namespace plumbline::scenarios
