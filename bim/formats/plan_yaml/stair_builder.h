// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "bim/formats/plan_yaml/plan_stair.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Dimensions of a stair's solids that a plan does not give, m.
struct StairBuilderConfig {
  double waist_m = 0.15;     ///< of a flight, across its pitch
  double landing_m = 0.2;    ///< thickness of a landing
  double head_room_m = 2.1;  ///< free height over every step and landing
  double step_off_m = 0.3;   ///< before the first and beyond the last step there must be floor
  double wall_m2 = 1e-3;     ///< a step may share this much ground with a wall
};

/// Equal steps that a height needs so that none is higher than rise_m. A double, since an
/// implausible height needs more than an int holds.
[[nodiscard]] double step_count(double height_m, double rise_m);

/// Why the entry's steps cannot be built for such a height, to follow the stair's name; nothing where they can.
[[nodiscard]] std::optional<std::string> step_fault(const PlanStairEntry& entry, double height_m);

/// Flights, landings and closed bodies of a stair that rises height_m from z0_m; `from`, `to` and the rooms are left to
/// the caller. As many equal steps as keep each within rise_m; the last is flush with the floor above, the one before
/// a landing with the landing.
[[nodiscard]] Stair build_stair(const PlanStairEntry& entry, double z0_m, double height_m,
                                const StairBuilderConfig& config = {});

}  // namespace plumbline::bim
