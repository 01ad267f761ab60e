// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/recordings/recording.h"

namespace plumbline::scenarios {

/// What a recording keeps back, as a slower or plainer sensor would.
struct Degradation {
  int every = 1;          ///< the first scan and every Nth after it are given; at least 1
  bool no_rings = false;  ///< a scan is one ring, with a column for each return slot
  bool no_times = false;  ///< all returns have the scan's stamp
  double within_m = 0.0;  ///< returns farther than this are lost; 0: none
  int one_of = 1;         ///< of so many returns one is kept, drawn at random
  int beams = 0;          ///< returns of so many narrow cones are kept, evenly spread over elevations; 0: all

  /// Whether returns are lost.
  [[nodiscard]] bool thins() const { return within_m > 0.0 || one_of != 1 || beams != 0; }
  [[nodiscard]] bool any() const { return every != 1 || no_rings || no_times || thins(); }
};

/// The recording with fewer or plainer scans and with all its odometry and IMU: records up to a scan that is left out
/// come with the next one that is given.
[[nodiscard]] std::unique_ptr<slam::Recording> degraded(std::unique_ptr<slam::Recording> recording,
                                                        const Degradation& degradation);

}  // namespace plumbline::scenarios
