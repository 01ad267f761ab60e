// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

struct GateCount {
  std::size_t passed = 0, all = 0;
};

/// Of one method, or of all where `method` is empty.
[[nodiscard]] GateCount gates_of(const ReportInput& input, const std::string& method);

/// Methods that no gate judges and whose verdict is not a good one: "amcl: overconfident, not judged".
[[nodiscard]] std::vector<std::string> unjudged(const ReportInput& input);

/// What each method did, in a sentence or two, its verdict and gates, and what it says at the time shown.
[[nodiscard]] std::string method_cards(const ReportInput& input);

}  // namespace plumbline::scenarios
