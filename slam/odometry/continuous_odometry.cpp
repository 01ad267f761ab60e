// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/continuous_odometry.h"

namespace plumbline::slam {

OdometrySample ContinuousOdometry::to(const Pose& X_BR, const DeskewedScan& scan, const OdometryHealth& health,
                                      const std::optional<ExpectedMotion>& continued) {
  Pose X_OR = X_OB_ ? *X_OB_ * X_BR : X_BR;
  OdometrySample sample;
  if (last_) {
    sample.step = last_->X_OR.inverse() * X_OR;
    const ExpectedStep expected{scan.stamp - last_->stamp, last_->step, continued};
    const bool discontinuous = last_->stale || !health.is_plausible_step(sample.step, expected);
    if (discontinuous) {
      X_OB_ = join_frames(last_->X_OR, X_BR);
      X_OR = *X_OB_ * X_BR;
      sample.step = last_->X_OR.inverse() * X_OR;
    }
    sample.valid = !discontinuous && !scan.odometry_stale;
    const double age_s = seconds(scan.odometry_age), last_age_s = seconds(last_->age);
    constexpr double acceleration_mps2 = 2.0, turn_acceleration_radps2 = 4.0;
    const double extrapolated_s2 = age_s * age_s + last_age_s * last_age_s;
    sample.extrapolated_m = acceleration_mps2 * extrapolated_s2;
    sample.extrapolated_rad = turn_acceleration_radps2 * extrapolated_s2;
    if (sample.valid) sample.sigma_m = measured_sigma_m + sample.extrapolated_m;
  }
  sample.q_OR = X_OR.q;
  const Nanoseconds dt = last_ ? scan.stamp - last_->stamp : 0;
  last_ = Last{scan.stamp, X_OR, scan.odometry_stale, scan.odometry_age, std::nullopt};
  if (sample.valid && dt > 0) last_->step = ExpectedMotion(sample.step);
  return sample;
}

}  // namespace plumbline::slam
