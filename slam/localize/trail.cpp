// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/trail.h"

namespace plumbline::slam {

std::vector<StampedPose> Trail::poses(const Pose& X_WI) const {
  std::vector<StampedPose> poses;
  if (corrections_.empty()) return poses;
  std::size_t next = 0;
  for (const StampedPose& scan : scans_) {
    while (next < corrections_.size() && corrections_[next].stamp < scan.stamp) ++next;
    Pose X_IO = corrections_[next == corrections_.size() ? next - 1 : next].X_FR;
    if (next > 0 && next < corrections_.size()) {
      const StampedPose& before = corrections_[next - 1];
      const StampedPose& after = corrections_[next];
      const double s = static_cast<double>(scan.stamp - before.stamp) / static_cast<double>(after.stamp - before.stamp);
      // Interpolated at the robot: O's origin may be far, and turning about it would swing the pose.
      poses.push_back({scan.stamp, X_WI * interpolate(before.X_FR * scan.X_FR, after.X_FR * scan.X_FR, s)});
      continue;
    }
    poses.push_back({scan.stamp, X_WI * (X_IO * scan.X_FR)});
  }
  return poses;
}

}  // namespace plumbline::slam
