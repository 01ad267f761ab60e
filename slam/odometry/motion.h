// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Recent odometry, to be asked for the robot's motion between scan times.
class MotionBuffer {
 public:
  void add(const Odometry& odometry);
  /// X_OR at time t, interpolated; the nearest pose outside the buffer. Needs at least one record, else InternalError.
  [[nodiscard]] Pose at(Nanoseconds t) const;
  [[nodiscard]] bool empty() const { return records_.empty(); }
  /// Drops what is older than t.
  void forget_before(Nanoseconds t);

 private:
  std::deque<Odometry> records_;
};

/// A scan with every return moved to R at scan.stamp.
struct DeskewedScan {
  Nanoseconds stamp = 0;
  int rings = 16;
  int columns = 0;
  std::vector<double> range_m;           ///< as measured; 0: no return
  std::vector<Eigen::Vector3d> point_R;  ///< at stamp; zero where there is no return
  Pose X_RL;                             ///< sensor in R
};

/// Undoes the robot's motion during the sweep by the odometry's relative poses.
[[nodiscard]] DeskewedScan deskew(const Scan& scan, const MotionBuffer& motion, const Calibration& calibration);

/// One point per occupied voxel (the mean of its points), ordered by voxel; voxel size in m.
[[nodiscard]] std::vector<Eigen::Vector3d> voxel_downsample(const std::vector<Eigen::Vector3d>& points, double size);

}  // namespace plumbline::slam
