// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bim/geometry/pose.h"

namespace plumbline::slam::kiss {

/// How far scans lay from where constant velocity led: the scale of correspondences [vizzo2023]. Nothing
/// is ever forgotten.
class AdaptiveThreshold {
 public:
  /// initial_m counts as the first deviation. Those up to min_motion_m do not count. A rotation counts as the way of a
  /// point max_range_m away.
  AdaptiveThreshold(double initial_m, double min_motion_m, double max_range_m)
      : min_motion_m_(min_motion_m), max_range_m_(max_range_m), sum_m2_(initial_m * initial_m) {}

  /// deviation: the pose found, seen from the pose predicted.
  void add(const Pose& deviation);
  /// Root mean square of the deviations, m.
  [[nodiscard]] double sigma_m() const;

 private:
  double min_motion_m_;
  double max_range_m_;
  double sum_m2_;
  std::int64_t count_ = 1;
};

}  // namespace plumbline::slam::kiss
