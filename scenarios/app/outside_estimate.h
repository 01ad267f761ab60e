// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios {

/// An estimate of another program or of plumbline estimate.
struct Outside {
  MethodRecord method;
  std::vector<std::string> altered;  ///< files that are not as they were written, as "NAME=FILE"
  std::string said;                  ///< what was found out about it, a line, or nothing
};

/// Of NAME=DIR or NAME=FILE[,frame=W|M][,topic=TOPIC][,shift=S|auto]. Throws InputError where it cannot be of the run.
[[nodiscard]] Outside read_outside(const std::string& text, const std::string& run_dir, const FinishedRun& run,
                                   bool unchecked);

}  // namespace plumbline::scenarios
