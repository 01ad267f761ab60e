// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios::score {

/// Rules of the search for the shift between two clocks.
struct ShiftRules {
  double step_s = 0.1;            ///< of the first search
  double window_s = 1.0;          ///< over which motions are compared; longer than a step of the gait
  double least_overlap = 0.8;     ///< of the shorter of the two
  double most_longer_s = 3600.0;  ///< than the walk; bounds the search, since an estimate says how long it is
  /// The mean square of what is left at the best shift is at most this share of that at any shift further than a window
  /// from it. A walk whose laps are alike, or that neither turns nor stops, has no such shift. Assumed.
  double most_of_next = 0.5;
  double fine_s = 0.001;  ///< of the last search
};

/// What is to be added to the stamps of an estimate so that it moves when the robot did: by distances and turns over a
/// window, which neither frames nor the place on the robot change, then by the least aligned error. Where the poses are
/// then those of scans, to a millisecond, it is exact. Absent where no shift or more than one fits,
/// or the estimate lasts much longer than the walk.
[[nodiscard]] std::optional<slam::Nanoseconds> find_shift(const Truth& truth,
                                                          const std::vector<slam::StampedPose>& poses_F,
                                                          const ShiftRules& rules = {});

}  // namespace plumbline::scenarios::score
