// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/health.h"

#include <algorithm>

namespace plumbline::slam {

namespace {

constexpr double noise_m = 0.05;  ///< registration's own scatter, which no speed explains
constexpr double noise_rad = 0.05;
constexpr double least_dt_s = 1e-3;

}  // namespace

bool OdometryHealth::assess(const Registration& registration, const Pose& step, Nanoseconds dt) {
  const bool sound = step.t.allFinite() && step.q.coeffs().allFinite();
  const bool good = sound && registration.matched >= config_.min_matched && is_plausible_step(step, dt);
  good_ = good ? good_ + 1 : 0;
  bad_ = good ? 0 : bad_ + 1;
  if (bad_ >= config_.bad_scans) lost_ = true;
  if (good_ >= config_.good_scans) lost_ = false;
  return good;
}

bool OdometryHealth::is_plausible_step(const Pose& step, Nanoseconds dt) const {
  const double dt_s = std::max(seconds(dt), least_dt_s);
  return step.t.norm() <= config_.max_speed_mps * dt_s + noise_m &&
         log_so3(step.q).norm() <= config_.max_turn_radps * dt_s + noise_rad;
}

}  // namespace plumbline::slam
