// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/hunt/blame.h"
#include "scenarios/shrink/run_case.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

/// What the methods of a run do one by one.
struct MethodsAlone {
  std::vector<MethodOutcome> outcomes;  ///< empty where no method is at fault
  std::string why;                      ///< where it is empty, why
};

/// Tries each method by itself, and the walk with the truth alone, after all together ended the program as `together`
/// says. Methods are at fault only where the walk does not end the program without them. One that is killed is not: as
/// a rule memory was short, which is of the machine.
[[nodiscard]] MethodsAlone methods_alone(const RunCase& run, const Trial& together, const TryCases& try_all);

/// Methods that the scenario names.
[[nodiscard]] std::vector<std::string> methods_of_case(const RunCase& run);
/// With one method alone and its gates.
[[nodiscard]] RunCase with_method(RunCase run, const std::string& method);

}  // namespace plumbline::scenarios
