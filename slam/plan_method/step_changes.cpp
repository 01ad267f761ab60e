// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/step_changes.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

void StepChanges::add(const Pose& X_MR) {
  constexpr int most_scans = 20;  // some steps of a trot; assumed
  if (last_X_MR_) {
    const Pose step = last_X_MR_->inverse() * X_MR;
    if (last_step_) {
      scans_ = std::min(scans_ + 1, most_scans);
      const double share = 1.0 / scans_, yaw = wrap_angle(step.yaw() - last_step_->yaw());
      translation_m2_ += share * ((step.t - last_step_->t).head<2>().squaredNorm() - translation_m2_);
      yaw_rad2_ += share * (yaw * yaw - yaw_rad2_);
      tilt_rad2_ += share * (log_so3(last_step_->q.conjugate() * step.q).head<2>().squaredNorm() - tilt_rad2_);
    }
    last_step_ = step;
  }
  last_X_MR_ = X_MR;
}

void StepChanges::interrupt() {
  last_X_MR_.reset();
  last_step_.reset();
}

Eigen::Matrix3d StepChanges::covariance() const {
  const double axis_m2 = 0.5 * translation_m2_;
  return 0.25 * Eigen::Vector3d(axis_m2, axis_m2, yaw_rad2_).asDiagonal().toDenseMatrix();
}

double StepChanges::tilt_sigma() const { return 0.5 * std::sqrt(0.5 * tilt_rad2_); }

}  // namespace plumbline::slam
