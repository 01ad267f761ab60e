// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// What failed and by how much, where it is seen first; empty where nothing failed.
[[nodiscard]] std::string failed_gates(const ReportInput& input);

/// A row for each gate; empty where there is none.
[[nodiscard]] std::string gates_table(const ReportInput& input);

/// Every number of the results, a column for each method.
[[nodiscard]] std::string numbers_table(const ReportInput& input);

}  // namespace plumbline::scenarios
