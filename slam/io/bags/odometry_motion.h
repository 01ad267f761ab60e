// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

/// What nav_msgs/Odometry holds of records besides their poses: the mean twist since the record before with its
/// covariance, and the covariance of the pose, to which the motions' since the first record add up.
class OdometryMotion {
 public:
  /// Of the next record, without names of frames; all zero but the pose where no covariance is known.
  [[nodiscard]] ros::OdometryMessage message(const Odometry& record, const std::optional<Matrix6d>& covariance);

 private:
  std::optional<Odometry> before_;
  Matrix6d covariance_R_ = Matrix6d::Zero();  ///< of the last pose, as a right increment
};

/// The bag's odometry frame B in O, which starts at the robot's first position and heading.
[[nodiscard]] Pose start_of_odometry(const Pose& X_BR);

/// Covariance of the motion in dt from that of the twist; none where the message holds no usable one.
[[nodiscard]] std::optional<Matrix6d> increment_covariance(const ros::OdometryMessage& message, Nanoseconds dt);

/// Whether records, the oldest first, tell the motion up to t. One record alone, long before, tells where a scan began
/// and nothing of how far the robot went during it.
[[nodiscard]] bool tells_motion(const std::vector<Odometry>& records, Nanoseconds t);

}  // namespace plumbline::slam
