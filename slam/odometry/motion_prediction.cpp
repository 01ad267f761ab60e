// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/motion_prediction.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

constexpr double forget = 0.9;

template <std::size_t N>
std::size_t least(const std::array<double, N>& errors) {
  return static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) - errors.begin());
}

}  // namespace

void MotionPrediction::add(const Pose& step, Nanoseconds dt) {
  const Rate rate{log_se3(step) / seconds(dt), dt};
  if (!rates_.empty())
    for (std::size_t k = 0; k < windows.size(); ++k) {
      const Vector6d error = (rate.per_s - mean(windows[k])) * seconds(dt);
      translation_errors_[k] = forget * translation_errors_[k] + (1.0 - forget) * error.head<3>().squaredNorm();
      rotation_errors_[k] = forget * rotation_errors_[k] + (1.0 - forget) * error.tail<3>().squaredNorm();
    }
  rates_.push_back(rate);
  if (rates_.size() > windows.back()) rates_.pop_front();
}

std::optional<Pose> MotionPrediction::over(Nanoseconds dt) const {
  if (rates_.empty()) return std::nullopt;
  constexpr double most_steps = 3.0, acceleration_mps2 = 2.0;
  const double most_s = most_steps * seconds(rates_.back().dt);
  Vector6d step;
  step.head<3>() = mean(windows[least(translation_errors_)]).head<3>();
  step.tail<3>() = mean(windows[least(rotation_errors_)]).tail<3>();
  step.head<3>() *= std::min(seconds(dt), std::max(most_s, step.head<3>().norm() / acceleration_mps2));
  step.tail<3>() *= std::min(seconds(dt), most_s);
  return exp_se3(step);
}

double MotionPrediction::sigma_m() const { return std::sqrt(translation_errors_[least(translation_errors_)]); }

double MotionPrediction::sigma_rad() const { return std::sqrt(rotation_errors_[least(rotation_errors_)]); }

double MotionPrediction::speed_mps() const {
  return rates_.empty() ? 0.0 : mean(windows[least(translation_errors_)]).head<3>().norm();
}

Vector6d MotionPrediction::mean(std::size_t window) const {
  const std::size_t n = std::min(window, rates_.size());
  Vector6d sum = Vector6d::Zero();
  for (std::size_t k = rates_.size() - n; k < rates_.size(); ++k) sum += rates_[k].per_s;
  return sum / static_cast<double>(n);
}

}  // namespace plumbline::slam
