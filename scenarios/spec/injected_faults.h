// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// What a scenario makes go wrong, a sentence part each, with the sizes of its presets: "the feet slip at 1 m/s, for
/// 0.2 s in every 10 s". Errors of clocks, mount, IMU, feet and ranges, returns of dust, hard ground, pushes,
/// kidnapping. Empty of a scenario that injects nothing.
[[nodiscard]] std::vector<std::string> injected_faults(const Scenario& scenario);

/// An episode of slipping, on the run's clock.
struct SlipEpisode {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// The last episode that begins at or before a time and ends at most three seconds before it; nothing of a robot that
/// is kidnapped, whose slips begin anew.
[[nodiscard]] std::optional<SlipEpisode> slip_before(const Scenario& scenario, double t_s);

}  // namespace plumbline::scenarios
