// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// "METRIC<=X" or "METRIC>=X", as --gate has it, blanks around the sign allowed; of no method yet. Throws InputError
/// about --gate where it is not of this form or X is no number. Whether there is such a metric is not looked at.
[[nodiscard]] GateSpec parse_gate(const std::string& text);

}  // namespace plumbline::scenarios
