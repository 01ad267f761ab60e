// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// What the script of the report reads, as JSON that cannot end its script element: tracks by method, states, and for
/// each plot the curves by whose values the legend and the tip speak.
[[nodiscard]] std::string script_data(const ReportInput& input, double end_s);

}  // namespace plumbline::scenarios
