// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/health.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bim/median.h"

namespace plumbline::slam {

namespace {

bool within(const Pose& expected, const Pose& step, double way_m, double turn_rad) {
  const Pose difference = expected.inverse() * step;
  return difference.t.norm() <= way_m && log_so3(difference.q).norm() <= turn_rad;
}

bool meets(const ExpectedMotion& motion, const Pose& step) {
  constexpr double sigmas = 4.0;
  constexpr double noise_m = 0.05, noise_rad = 0.02;  // registration's own scatter, which no motion explains
  constexpr double most_m = 0.3, most_rad = 0.35;     // of an expectation that excludes something
  constexpr double most_of_way = 0.03;                // of a long way, which starts in a direction known to 2 degrees
  if (std::isinf(motion.sigma_m)) return true;
  const double most_way_m = std::max(most_m, most_of_way * motion.step.t.norm());
  return within(motion.step, step, std::min(most_way_m, sigmas * motion.sigma_m + noise_m),
                std::min(most_rad, sigmas * motion.sigma_rad + noise_rad));
}

}  // namespace

double surprise_m(const Pose& step, const Pose& expected) {
  constexpr double near_m = 3.0;
  const Pose difference = expected.inverse() * step;
  return difference.t.norm() + near_m * log_so3(difference.q).norm();
}

bool OdometryHealth::assess(const Registration& registration, const Pose& step, const ExpectedStep& expected) {
  const bool sound = step.t.allFinite() && step.q.coeffs().allFinite();
  const bool good = sound && registration.matched >= least_matched(registration, step, expected) &&
                    is_plausible_step(step, expected) &&
                    (is_as_usual(registration) || is_expected_step(step, expected));
  good_ = good ? good_ + 1 : 0;
  bad_ = good ? 0 : bad_ + 1;
  if (bad_ >= config_.bad_scans) lost_ = true;
  if (good_ >= config_.good_scans) lost_ = false;
  if (good) {
    matched_.push_back(registration.matched);
    residuals_.push_back(registration.residual_m);
  }
  if (matched_.size() > static_cast<std::size_t>(config_.recent_scans)) {
    matched_.pop_front();
    residuals_.pop_front();
  }
  return good;
}

void OdometryHealth::restart() {
  matched_.clear();
  residuals_.clear();
}

double OdometryHealth::usual() const {
  return matched_.empty() ? 0.0 : upper_median(std::vector<double>(matched_.begin(), matched_.end()));
}

double OdometryHealth::usual_matched() const {
  constexpr std::size_t enough = 5;
  return matched_.size() < enough ? 1.0 : usual();
}

double OdometryHealth::usual_residual() const {
  return residuals_.empty() ? 0.0 : upper_median(std::vector<double>(residuals_.begin(), residuals_.end()));
}

double OdometryHealth::least_matched(const Registration& registration, const Pose& step,
                                     const ExpectedStep& expected) const {
  constexpr double about = 1.5;
  const bool confirmed = registration.residual_m > 0.0 && registration.residual_m <= about * usual_residual() &&
                         is_expected_step(step, expected);
  return std::max(config_.min_matched, (confirmed ? config_.confirmed_share : config_.usual_share) * usual());
}

OdometryHealth::Reach OdometryHealth::reach(Nanoseconds dt) const {
  const double dt_s = std::max(seconds(dt), 0.0);
  return {config_.max_deviation_m + config_.max_acceleration_mps2 * dt_s * dt_s,
          config_.max_deviation_rad + config_.max_turn_acceleration_radps2 * dt_s * dt_s};
}

bool OdometryHealth::is_plausible_step(const Pose& step, const ExpectedStep& expected) const {
  const double dt_s = std::max(seconds(expected.dt), 0.0);
  const auto [way_m, turn_rad] = reach(expected.dt);
  if (expected.odometry && within(expected.odometry->step, step, way_m, turn_rad)) return true;
  if (expected.continued && within(expected.continued->step, step, way_m, turn_rad)) return true;
  if (expected.odometry || expected.continued) return false;
  return within(Pose{}, step, std::max(config_.max_start_speed_mps * dt_s, way_m), turn_rad);
}

bool OdometryHealth::is_expected_step(const Pose& step, const ExpectedStep& expected) {
  if (expected.odometry && meets(*expected.odometry, step)) return true;
  if (expected.continued && meets(*expected.continued, step)) return true;
  return !expected.odometry && !expected.continued;
}

}  // namespace plumbline::slam
