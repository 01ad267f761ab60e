// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// Text of a key of results.json, empty where there is none.
[[nodiscard]] std::string text_of(const Tree& map, std::string_view key);
/// Number of a key; `map` may be null.
[[nodiscard]] std::optional<double> number_of(const Tree* map, std::string_view key);
/// Time of the first scan on the run's clock, from which results count: converged_at_s, identifiability, s.
[[nodiscard]] double start_s(const ReportInput& input);
/// Block of a method, or null.
[[nodiscard]] const Tree* results_of(const Tree& results, const std::string& method);
[[nodiscard]] const Tree* results_of(const ReportInput& input, const std::string& method);

}  // namespace plumbline::scenarios
