// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "bim/errors.h"
#include "bim/model/building.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Where on a storey no floor is stood on: under or over a stair.
[[nodiscard]] bool on_a_stair(const bim::Building& building, int storey, const Eigen::Vector2d& p_W);

/// In the plane: in a door that is open, or a void, of a storey's walls.
[[nodiscard]] bool in_a_doorway(const bim::Building& building, int storey, const Eigen::Vector2d& p_W);

/// Throws InputError at the mark unless the robot can stand at a point of a storey.
void check_start(const sim::MultiStoreyPlanner& space, int storey, const Eigen::Vector2d& at, const Mark& mark);

/// As messages write it: "[1.2, 3.4]".
[[nodiscard]] std::string point_text(const Eigen::Vector2d& p);

}  // namespace plumbline::scenarios
