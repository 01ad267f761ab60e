// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/plan_map/likelihood.h"

namespace plumbline::slam {

/// What WallBlocks::log_likelihood() is, wall by wall and in double precision.
[[nodiscard]] double wall_log_likelihood(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                         const LikelihoodConfig& config);

}  // namespace plumbline::slam
