// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/unmeasured_way.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline::slam {

namespace {

constexpr double correlation_s = 0.1;  ///< how long an acceleration lasts

}  // namespace

// Over less than an acceleration lasts it is the same; over more, many of them add up.
void UnmeasuredWay::measure_acceleration(double sigma_m, Nanoseconds dt) {
  const double dt_s = seconds(dt);
  if (!(dt_s > 0.0) || !(sigma_m >= 0.0)) return;
  const double measured_mps2 = sigma_m / (dt_s * std::min(dt_s, std::sqrt(correlation_s * dt_s)));
  acceleration_mps2_ = std::clamp(measured_mps2, least_mps2, most_mps2);
}

void UnmeasuredWay::add_measured(Nanoseconds dt, bool as_usual) {
  // One that tells something now and then is a stray: it takes twice the time to make up for one that told nothing.
  open_s_ = std::max(0.0, open_s_ - 0.5 * seconds(dt));
  if (as_usual) frozen_m_ = 0.0;
}

void UnmeasuredWay::add_open(Nanoseconds dt) {
  open_s_ += seconds(dt);
  if (lost()) map_m_ = std::max(map_m_, open_m());
}

void UnmeasuredWay::add_frozen(Nanoseconds dt, double speed_mps) {
  open_s_ += seconds(dt);
  frozen_m_ += speed_mps * seconds(dt);
}

void UnmeasuredWay::begin_map() {
  map_m_ = std::max(map_m_, doubt_m_) + open_m();
  doubt_m_ = 0.0;
  open_s_ = 0.0;
  frozen_m_ = 0.0;
}

void UnmeasuredWay::measure_from(const UnmeasuredWay& then) {
  open_s_ = std::min(open_s_, then.open_s_);
  frozen_m_ = std::min(frozen_m_, then.frozen_m_);
  map_m_ = std::min(map_m_, then.map_m_);
  doubt_m_ = std::min(doubt_m_, then.doubt_m_);
}

// A speed that random accelerations change, integrated.
double UnmeasuredWay::open_m() const {
  return frozen_m_ + acceleration_mps2_ * std::sqrt(correlation_s * open_s_ * open_s_ * open_s_ / 3.0);
}

Pose measured_part(const Registration& result, const Pose& step, const Pose& expected) {
  if (result.unobserved.empty() || result.by_rough_points || result.correlated) return step;
  constexpr double arm_m = 3.0;  // at which a rotation moves what is seen: of rooms. Assumed
  const Vector6d scale = (Vector6d() << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(arm_m)).finished();
  Vector6d off = scale.cwiseProduct(log_se3(expected.inverse() * step));
  std::vector<Vector6d> open;
  for (const Vector6d& unobserved : result.unobserved) {
    Vector6d direction = scale.cwiseProduct(unobserved);
    for (const Vector6d& other : open) direction -= other.dot(direction) * other;
    if (direction.norm() < 1e-9) continue;
    open.push_back(direction.normalized());
    off -= open.back().dot(off) * open.back();
  }
  return expected * exp_se3(off.cwiseQuotient(scale));
}

}  // namespace plumbline::slam
