// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/metrics/metrics.h"

namespace plumbline::scenarios {

/// score.json of an estimate.
struct EstimateScores {
  Tree numbers;  ///< a map; its values are text, numbers of at most 1e30, lists, and maps of these
  std::vector<score::GateResult> gates;  ///< without links
};

/// Texts of the files that a score leaves, before they are written.
struct NewScore {
  std::string scores;     ///< score.json
  std::string reference;  ///< reference.tum; empty: none
};

/// Reads score.json. Throws InputError at what the page cannot show: blocks that are no maps, numbers that are too
/// large, gates without their parts, more than a few hundred values.
[[nodiscard]] EstimateScores read_estimate_scores(std::string_view text, const std::string& file);

}  // namespace plumbline::scenarios
