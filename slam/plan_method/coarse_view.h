// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Mean ranges of a scan by direction in L, in cells of 3 degrees of azimuth and elevation: whether the LiDAR stands is
/// seen by comparing two.
class CoarseView {
 public:
  CoarseView() = default;
  explicit CoarseView(const Scan& scan);

  /// Share of the cells that both scans fill in which the mean range is the same within 4 cm; 0 where these are fewer
  /// than half of those that either fills. Near 1 also along a bare corridor: scan matching has to tell.
  [[nodiscard]] double unchanged_share(const CoarseView& other) const;

 private:
  std::vector<float> range_m_;  ///< by cell; 0: none
};

}  // namespace plumbline::slam
