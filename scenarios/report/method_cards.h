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
[[nodiscard]] GateCount gates_of(const Tree& results, const std::string& method);

/// What went wrong with a method and is judged by no gate.
struct Unjudged {
  std::string method;
  std::string what;                                                 ///< its verdict, or what its verdict does not say
  [[nodiscard]] bool crashed() const { return what == "crashed"; }  ///< which fails a run without any gate
  [[nodiscard]] std::string text() const { return method + ": " + what + (crashed() ? "" : ", not judged"); }
};

/// Methods without a gate whose verdict is not a good one, those that were kidnapped and not localized again, and SLAM
/// that is far off (score::TrajectoryRules) without a gate on its position error. Of results.json, of which gates and
/// methods are enough.
[[nodiscard]] std::vector<Unjudged> unjudged(const Tree& results);

/// What each method did, in a sentence or two, its verdict and gates, and what it says at the time shown.
[[nodiscard]] std::string method_cards(const ReportInput& input);

}  // namespace plumbline::scenarios
