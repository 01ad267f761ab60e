// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/health.h"

#include <algorithm>
#include <vector>

#include "bim/median.h"

namespace plumbline::slam {

namespace {

constexpr double noise_m = 0.05;  ///< registration's own scatter, which no motion explains
constexpr double noise_rad = 0.05;

}  // namespace

bool OdometryHealth::assess(const Registration& registration, const Pose& step, const ExpectedStep& expected) {
  const bool sound = step.t.allFinite() && step.q.coeffs().allFinite();
  const bool good = sound && registration.matched >= least_matched() && is_plausible_step(step, expected);
  good_ = good ? good_ + 1 : 0;
  bad_ = good ? 0 : bad_ + 1;
  if (bad_ >= config_.bad_scans) lost_ = true;
  if (good_ >= config_.good_scans) lost_ = false;
  if (good) matched_.push_back(registration.matched);
  if (matched_.size() > static_cast<std::size_t>(config_.recent_scans)) matched_.pop_front();
  return good;
}

double OdometryHealth::usual_matched() const {
  return matched_.empty() ? 1.0 : upper_median(std::vector<double>(matched_.begin(), matched_.end()));
}

double OdometryHealth::least_matched() const {
  if (matched_.empty()) return config_.min_matched;
  return std::max(config_.min_matched, config_.usual_share * usual_matched());
}

bool OdometryHealth::is_plausible_step(const Pose& step, const ExpectedStep& expected) const {
  const double dt_s = std::max(seconds(expected.dt), 0.0);
  const auto within = [&](const Pose& difference, double way_m, double turn_rad) {
    return difference.t.norm() <= way_m + noise_m && log_so3(difference.q).norm() <= turn_rad + noise_rad;
  };
  const double way_m = config_.max_acceleration_mps2 * dt_s * dt_s;
  const double turn_rad = config_.max_turn_acceleration_radps2 * dt_s * dt_s;
  if (expected.odometry && within(expected.odometry->inverse() * step, way_m, turn_rad)) return true;
  if (expected.continued && within(expected.continued->inverse() * step, way_m, turn_rad)) return true;
  if (expected.odometry || expected.continued) return false;
  return within(step, std::max(config_.max_start_speed_mps * dt_s, way_m), turn_rad);
}

}  // namespace plumbline::slam
