// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/corrected_trajectory.h"

#include <algorithm>

namespace plumbline::slam {

Pose CorrectedTrajectory::correction_at(Nanoseconds stamp, const Pose& X_OR) const {
  const auto after = std::lower_bound(corrections_.begin(), corrections_.end(), stamp,
                                      [](const StampedPose& c, Nanoseconds t) { return c.stamp < t; });
  if (after == corrections_.end()) return corrections_.back().X_FR;
  if (after == corrections_.begin()) return after->X_FR;
  const auto before = after - 1;
  const double s = static_cast<double>(stamp - before->stamp) / static_cast<double>(after->stamp - before->stamp);
  // Interpolated at the robot: O's origin may be far, and turning about it would swing the pose.
  const Pose& X_FO_before = before->X_FR;
  const Pose& X_FO_after = after->X_FR;
  return interpolate(X_FO_before * X_OR, X_FO_after * X_OR, s) * X_OR.inverse();
}

std::vector<StampedPose> CorrectedTrajectory::poses(const Pose& X_WI) const {
  std::vector<StampedPose> poses;
  if (corrections_.empty()) return poses;
  for (const StampedPose& scan : scans_)
    poses.push_back({scan.stamp, X_WI * (correction_at(scan.stamp, scan.X_FR) * scan.X_FR)});
  return poses;
}

}  // namespace plumbline::slam
