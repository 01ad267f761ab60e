// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/recordings/recording.h"

namespace plumbline::scenarios {

/// What a recording keeps back, as a slower or plainer sensor would.
struct Poverty {
  int every = 1;          ///< the first scan and every Nth after it are given; at least 1
  bool no_rings = false;  ///< a scan is one ring, with a column for each return slot
  bool no_times = false;  ///< all returns have the scan's stamp

  [[nodiscard]] bool any() const { return every != 1 || no_rings || no_times; }
};

/// A scan without what `poverty` keeps back. Order, points and stamp stay.
void impoverish(slam::Scan& scan, const Poverty& poverty);

/// The recording with fewer or plainer scans and with all its odometry and IMU: records up to a scan that is left out
/// come with the next one that is given.
[[nodiscard]] std::unique_ptr<slam::Recording> poorer(std::unique_ptr<slam::Recording> recording,
                                                      const Poverty& poverty);

}  // namespace plumbline::scenarios
