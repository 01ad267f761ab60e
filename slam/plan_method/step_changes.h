// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "bim/geometry/pose.h"

namespace plumbline::slam {

/// How much the robot's step changes from scan to scan. Without odometry a scan tells the mean motion during its sweep,
/// and its pose at the end follows by half of a step that is taken as steady: off by about half of this change. Errors
/// of the ends that are independent from scan to scan come out 1.2 times as large.
class StepChanges {
 public:
  /// The pose at the next scan, in any fixed frame.
  void add(const Pose& X_MR);
  /// The way to the next scan is not known.
  void interrupt();

  /// Of (x, y, yaw) at a sweep's end, over about the last 20 scans: m^2 and rad^2.
  [[nodiscard]] Eigen::Matrix3d covariance() const;
  /// Standard deviation of roll, and of pitch, at a sweep's end, rad.
  [[nodiscard]] double tilt_sigma() const;

 private:
  std::optional<Pose> last_X_MR_, last_step_;
  int scans_ = 0;
  double translation_m2_ = 0.0, yaw_rad2_ = 0.0, tilt_rad2_ = 0.0;  ///< mean squares of the changes
};

}  // namespace plumbline::slam
