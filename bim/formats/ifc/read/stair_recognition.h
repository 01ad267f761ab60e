// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/model/building.h"

namespace plumbline::bim {

/// What counts as a step [stairs in the building codes of Europe and the US: rise 0.10 to 0.22 m, run 0.21 to 0.37 m].
struct StairRecognitionConfig {
  double level_m = 5e-3;        ///< up-facing triangles this close in height belong to one tread
  double upright = 0.999;       ///< cosine of the tilt of a tread, at least
  double headroom_m = 1.5;      ///< a face covers the one below when it is less than this above it
  double least_depth_m = 0.12;  ///< narrower faces (tops of risers, stringers and rails) are no treads
  double least_width_m = 0.30;  ///< ... nor shorter ones
  double most_rise_m = 0.30;    ///< a higher step ends the flight
  double rise_slack_m = 0.02;   ///< rises of one flight differ by less than this
  double landing_runs = 1.8;    ///< a tread with more than this times the median area is a landing
  double turn_rad = 0.1;        ///< directions of one flight differ by less than this
  double sideways_m = 0.1;      ///< ... and its treads lie no further off its line
  double grid_m = 1e-4;         ///< of lengths and heights
  double step_grid_m = 1e-6;    ///< of rise and run, which add up over a flight
};

struct RecognizedStair {
  std::vector<StairFlight> flights;  ///< from the lowest up
  std::vector<Landing> landings;     ///< from the lowest up
};

/// Flights and landings found in the bodies of a stair: level faces that can be stepped on, in order of height, taken
/// together while they rise and advance alike. A winding stair becomes a row of short flights. Empty when the bodies
/// have no level faces.
[[nodiscard]] RecognizedStair recognize_stair(const std::vector<Solid>& bodies,
                                              const StairRecognitionConfig& config = {});

}  // namespace plumbline::bim
