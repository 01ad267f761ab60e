// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/localizability/aliased_poses.h"
#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

/// Input of answer_by_walks: the scan of every cell of the map, in its order.
struct WalkInput {
  const LocalizabilityMapInput& input;
  const AliasFinder& finder;
  const std::vector<ReferenceScan>& scans;
};

/// Fills the answers of a map whose aliases are known. Returns how many scans it compared with how many images.
std::uint64_t answer_by_walks(const WalkInput& walks, LocalizabilityMap& map);

}  // namespace plumbline::scenarios
