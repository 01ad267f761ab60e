// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bim/model/building.h"

namespace plumbline::bim {

/// IFC counts a wall's layers along y of its placement, hence x runs along the reference line from a. Points in that
/// frame Q; z as in W.
[[nodiscard]] Eigen::Vector3d into_placement(const Wall& wall, const Eigen::Vector3d& p_W);

/// Back to W, on the grid of solids: turning there and back leaves less than the grid.
[[nodiscard]] Solid out_of_placement(const Wall& wall, Solid body_Q);

/// The body in Q, nothing where out_of_placement() would not give back just this one.
[[nodiscard]] std::optional<Solid> into_placement(const Wall& wall, const Solid& body_W);

}  // namespace plumbline::bim
