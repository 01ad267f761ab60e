// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/generators/generators.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// A walk through all rooms of the start's storey of a generated building and back, with time to spare, and no methods.
/// `plan_text`: its plan, as written; `building`: the path of that plan as the scenario has it. Throws InputError where
/// the walk cannot be walked.
[[nodiscard]] Scenario generated_walk(const bim::GeneratedPlan& generated, const std::string& plan_text,
                                      const std::string& building);

}  // namespace plumbline::scenarios
