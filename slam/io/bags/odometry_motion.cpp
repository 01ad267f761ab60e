// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/odometry_motion.h"

#include <cmath>

namespace plumbline::slam {

ros::OdometryMessage OdometryMotion::message(const Odometry& record, const std::optional<Matrix6d>& covariance) {
  ros::OdometryMessage message;
  message.X_OR = {record.stamp, "", "", record.X_OR};
  if (before_ && covariance && record.stamp > before_->stamp) {
    const double dt = seconds(record.stamp - before_->stamp);
    const Pose X_AB = before_->X_OR.inverse() * record.X_OR;
    message.twist = log_se3(X_AB) / dt;
    message.twist_covariance = *covariance / (dt * dt);
    const Matrix6d A = adjoint(X_AB.inverse());
    covariance_R_ = A * covariance_R_ * A.transpose() + *covariance;
    Matrix6d R = Matrix6d::Zero();
    R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = record.X_OR.rotation();
    message.pose_covariance = R * covariance_R_ * R.transpose();
  }
  before_ = record;
  return message;
}

Pose start_of_odometry(const Pose& X_BR) {
  const double yaw = X_BR.yaw();
  const bool at_start = X_BR.t.norm() < 1e-9 && std::abs(yaw) < 1e-9;
  return at_start ? Pose{} : Pose::from_xyz_yaw(X_BR.t, yaw).inverse();
}

std::optional<Matrix6d> increment_covariance(const ros::OdometryMessage& message, Nanoseconds dt) {
  const Matrix6d& twist = message.twist_covariance;
  if (dt <= 0 || !twist.allFinite() || twist.diagonal().minCoeff() <= 0.0) return std::nullopt;
  return twist * (seconds(dt) * seconds(dt));
}

bool tells_motion(const std::vector<Odometry>& records, Nanoseconds t) {
  constexpr Nanoseconds at_once = 20'000'000;  // in which a walking robot moves 2 cm
  return records.size() > 1 || (!records.empty() && t - records.back().stamp <= at_once);
}

}  // namespace plumbline::slam
