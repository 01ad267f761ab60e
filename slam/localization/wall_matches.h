// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/io/estimate.h"
#include "slam/localization/tracker.h"

namespace plumbline::slam {

/// Links as an estimate shows them, in the order of the links; `plan_W` is the one that the storey was made of.
[[nodiscard]] std::vector<WallMatch> wall_matches(const bim::Plan& plan_W, const StoreyIndex& storey,
                                                  const std::vector<WallLink>& links);

}  // namespace plumbline::slam
