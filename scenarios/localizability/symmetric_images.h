// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/geometry/pose.h"
#include "bim/model/building.h"

namespace plumbline::scenarios {

/// Proper isometries that map a storey of the plan onto itself or another one, exactly or nearly, as a LiDAR sees them:
/// under each of them the image of a pose may be its alias. In W, the identity left out.
[[nodiscard]] std::vector<Pose> storey_isometries(const bim::Building& plan);

}  // namespace plumbline::scenarios
