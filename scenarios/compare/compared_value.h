// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/compare/comparison.h"

namespace plumbline::scenarios {

enum class Outcome { right, wrong };

/// Pairs by what is_right() or is_wrong() says, with McNemar's test. Without a finding.
[[nodiscard]] ComparedValue compare_outcome(const std::vector<const RowPair*>& pairs, Outcome outcome);

/// Pairs by a metric of score::metrics() with a direction, with the signed-rank test. Without a finding.
/// A pair with a value in neither run is left out, and so is one where a run rightly claims no single pose
/// (honest_ambiguity). A distance or time to convergence counts where it is a success, as in a sweep's table.
[[nodiscard]] ComparedValue compare_metric(const std::vector<const RowPair*>& pairs, const std::string& metric);

}  // namespace plumbline::scenarios
