// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/extrapolation_errors.h"

#include <algorithm>

namespace plumbline::slam {

void ExtrapolationErrors::add(Nanoseconds stamp, const Pose& X_OR, const MotionBuffer& motion) {
  constexpr int most_scans = 20;  // as of StepChanges
  for (; !waiting_.empty() && motion.age_at(waiting_.front().stamp) == 0; waiting_.pop_front()) {
    const Pose error = waiting_.front().X_OR.inverse() * motion.at(waiting_.front().stamp);
    scans_ = std::min(scans_ + 1, most_scans);
    const double share = 1.0 / scans_;
    translation_m2_ += share * (error.t.head<2>().squaredNorm() - translation_m2_);
    yaw_rad2_ += share * (error.yaw() * error.yaw() - yaw_rad2_);
  }
  constexpr std::size_t most_waiting = 50;  // where no odometry comes
  if (waiting_.size() == most_waiting) waiting_.pop_front();
  waiting_.push_back({stamp, X_OR});
}

Eigen::Matrix3d ExtrapolationErrors::covariance() const {
  const double axis_m2 = 0.5 * translation_m2_;
  return Eigen::Vector3d(axis_m2, axis_m2, yaw_rad2_).asDiagonal().toDenseMatrix();
}

}  // namespace plumbline::slam
