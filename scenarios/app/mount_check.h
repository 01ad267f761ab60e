// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "slam/io/method.h"
#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::scenarios {

/// A rotation that pairs of vectors have in common.
struct CommonRotation {
  Eigen::Quaterniond q_AB = Eigen::Quaterniond::Identity();  ///< the least one, where all vectors lie along one line
  double fit = 0.0;  ///< share of the lengths' products that a . (q_AB * b) makes up, at most 1
};

/// Solves min sum |a - q_AB b|^2 by the singular values of sum a b' [kabsch1976]. The two have one length; without a
/// vector there is no answer.
[[nodiscard]] std::optional<CommonRotation> common_rotation(const std::vector<Eigen::Vector3d>& a,
                                                            const std::vector<Eigen::Vector3d>& b);

/// Whether the LiDAR is turned against its mount: translations and rotations by scans beside those of odometry, or
/// rotations beside the gyro's where there is no odometry, as in hand-eye calibration.
class MountCheck {
 public:
  void add(const slam::SensorFrame& frame);
  /// A sentence for the user; nothing where the mount fits or too little moves. `X_MR` are the poses of a method with
  /// stamps of scans, those at which it is LOST left out; `mount_RL` is the rotation of the mount as it is given.
  [[nodiscard]] std::optional<std::string> warning(const std::vector<slam::StampedPose>& X_MR,
                                                   const Eigen::Quaterniond& mount_RL) const;

 private:
  struct Motion {
    slam::Nanoseconds stamp = 0;
    Pose X_OR;
  };
  std::vector<Motion> by_odometry_, by_gyro_;  ///< at scans; the gyro's has no position
  std::optional<slam::Odometry> odometry_;
  std::optional<slam::Nanoseconds> last_imu_;
  Eigen::Quaterniond turned_ = Eigen::Quaterniond::Identity();
};

}  // namespace plumbline::scenarios
