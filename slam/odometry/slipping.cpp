// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/slipping.h"

#include <cmath>

namespace plumbline::slam {

bool SlipWatch::doubts(const Pose& odometry_step, const ExpectedMotion& continued) const {
  // Chosen on a corridor of 60 m where feet slip by 0.5 to 1.5 m/s. On three walks without slip no answer changes.
  constexpr double sigmas = 2.5, least_m = 0.01;
  const double off_m = (odometry_step.t - continued.step.t).norm();
  return off_m > (slipping_ ? least_m : sigmas * continued.sigma_m + least_m);
}

bool SlipWatch::shows_slip(const Registration& alone, const Pose& last_X_MR, const Pose& odometry_step,
                           const ExpectedMotion& continued, double usual_matched) {
  constexpr double as_usual = 0.8;  // as in VgicpOdometry
  constexpr double nearer = 0.5;
  const Eigen::Vector3d off_m = odometry_step.t - continued.step.t;
  const double along_m = off_m.normalized().dot((last_X_MR.inverse() * alone.X_MR).t - continued.step.t);
  slipping_ = alone.unobserved_directions == 0 && alone.matched >= as_usual * usual_matched &&
              std::abs(along_m) < nearer * off_m.norm();
  return slipping_;
}

OdometrySample without_step(const OdometrySample& odometry, const Pose& step, double sigma_m) {
  OdometrySample none = odometry;
  none.step = step;
  none.valid = false;
  none.sigma_m = sigma_m;
  return none;
}

DeskewedScan corrected_by(DeskewedScan scan, const Vector6d& twist) {
  correct_motion(scan, twist);
  return scan;
}

}  // namespace plumbline::slam
