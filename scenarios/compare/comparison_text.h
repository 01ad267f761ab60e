// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "scenarios/compare/comparison.h"

namespace plumbline::scenarios {

/// The two sides as the user named them.
struct ComparedNames {
  std::string a, b;
};

/// A line a value in columns, what else there is to know, and last the verdict.
[[nodiscard]] std::string comparison_text(const Comparison& comparison, const ComparedNames& names);
/// The same with all digits and all runs.
[[nodiscard]] Tree comparison_results(const Comparison& comparison, const ComparedNames& names);

}  // namespace plumbline::scenarios
