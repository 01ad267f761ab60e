// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/localizability/aliased_poses.h"
#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

/// What walks are judged by: the look of every cell of the map, in its order.
struct WalkInput {
  const IdentifyMapInput& input;
  const TwinFinder& finder;
  const std::vector<Look>& looks;
};

/// Fills the answers of a map whose twins are known.
void answer_by_walks(const WalkInput& walks, IdentifyMap& map);

}  // namespace plumbline::scenarios
