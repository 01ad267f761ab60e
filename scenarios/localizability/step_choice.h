// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace plumbline::scenarios {

/// What the time for a map is turned into: counted work, so that the step it allows is the same on every machine.
struct StepBudget {
  /// With all that belongs to a beam; the least measured (2.5e6 on AC20-FZK-Haus to 14e6 on 300 equal rooms).
  double beams_per_core_s = 2.5e6;
  double cores = 2.0;  ///< that a budget in seconds is for
  /// The power of the number of places with which work grows, until two maps tell: 1.0 to 1.1 measured on four
  /// buildings.
  double growth = 1.25;
  double coarse_places = 32.0;  ///< of the map that is made first; assumed, as the next
  double more_places = 4.0;     ///< times as many has the second one, which tells how work grows
};

/// A map made so far.
struct MapWork {
  double step_m = 0.0;
  std::size_t places = 0;
  std::uint64_t beams = 0;
};

/// The finest step of 0.5, 0.7, 1, 1.4, 2, ... (times any power of 2), but none below finest_m, whose map is expected
/// to take no more than the beams that are left, and to have no more than most_map_cells; the step of `coarse` where
/// none finer does.
[[nodiscard]] double finest_step(const MapWork& coarse, double beams_left, double finest_m,
                                 const StepBudget& budget = {});
/// The power of the number of places with which work grew from one map to a finer one, 1 to 2.
[[nodiscard]] double growth_between(const MapWork& coarse, const MapWork& fine);
/// The step of that row at which a floor of this area has no more than coarse_places, but none below finest_m.
[[nodiscard]] double coarse_step(double area_m2, double finest_m, const StepBudget& budget = {});
/// What a map at this step is expected to take after a coarser one, beams.
[[nodiscard]] double expected_beams(const MapWork& coarse, double step_m, const StepBudget& budget = {});

}  // namespace plumbline::scenarios
