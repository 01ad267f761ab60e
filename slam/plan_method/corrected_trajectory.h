// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "slam/io/estimate.h"

namespace plumbline::slam {

/// The whole trajectory: every scan by odometry, and corrections X_IO at the poses that were optimised.
class CorrectedTrajectory {
 public:
  void add_scan(Nanoseconds stamp, const Pose& X_OR) { scans_.push_back({stamp, X_OR}); }
  void add_correction(Nanoseconds stamp, const Pose& X_IO) { corrections_.push_back({stamp, X_IO}); }
  [[nodiscard]] bool empty() const { return corrections_.empty(); }

  /// X_WR at every scan: the correction interpolated between the nearest ones, held before the first (which carries the
  /// pose found back to the start) and after the last. Empty when there is no correction.
  [[nodiscard]] std::vector<StampedPose> poses(const Pose& X_WI) const;
  /// X_IO at one time, for the robot at X_OR. Needs a correction.
  [[nodiscard]] Pose correction_at(Nanoseconds stamp, const Pose& X_OR) const;

 private:
  std::vector<StampedPose> scans_;
  std::vector<StampedPose> corrections_;
};

}  // namespace plumbline::slam
