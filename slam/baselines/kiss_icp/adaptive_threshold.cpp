// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/adaptive_threshold.h"

#include <cmath>

namespace plumbline::slam::kiss {

void AdaptiveThreshold::add(const Pose& deviation) {
  const double sin_half_angle = deviation.q.vec().norm();
  const double deviation_m = deviation.t.norm() + 2.0 * max_range_m_ * sin_half_angle;
  if (!(deviation_m > min_motion_m_)) return;
  sum_m2_ += deviation_m * deviation_m;
  ++count_;
}

double AdaptiveThreshold::sigma_m() const { return std::sqrt(sum_m2_ / static_cast<double>(count_)); }

}  // namespace plumbline::slam::kiss
