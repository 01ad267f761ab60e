// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/app/command_line.h"
#include "scenarios/app/degraded_recording.h"

namespace plumbline::scenarios {

/// Options of `estimate` that degrade a recording: fewer scans, rings, point times or returns.
struct DegradationOptions {
  int every = 1;
  std::vector<std::string> without;
  double max_range_m = 0.0;
  int one_of = 1;
  int beams = 0;

  void declare(CommandLine& line);
  [[nodiscard]] Degradation value() const;
};

/// What differs from the recording, as keys of estimate.yaml.
void describe(const Degradation& degradation, Tree& tree);

}  // namespace plumbline::scenarios
