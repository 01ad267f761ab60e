// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/plan/plan.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios::score {

/// Height of the robot's base above the floor it stands on, m.
[[nodiscard]] double base_height_m();
/// The storey whose floor is nearest to that under a robot with its base at height z_W (ties: the lower index); 0
/// without storeys.
[[nodiscard]] int storey_of_base(const std::vector<bim::PlanStorey>& storeys, double z_W);
/// The storey on whose floor a thing at height z_W stands: the highest that begins below it, else the lowest.
[[nodiscard]] int storey_of_height(const std::vector<bim::PlanStorey>& storeys, double z_W);

/// Height of the middle of a found room's walls in F, m; absent when it names none of the estimate's.
[[nodiscard]] std::optional<double> height_of_room(const slam::Estimate& estimate, const slam::RoomNode& room);

}  // namespace plumbline::scenarios::score
