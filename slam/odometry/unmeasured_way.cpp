// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/unmeasured_way.h"

#include <algorithm>
#include <cmath>

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
  map_m_ += open_m();
  open_s_ = 0.0;
  frozen_m_ = 0.0;
}

void UnmeasuredWay::measure_from(const UnmeasuredWay& then) {
  open_s_ = std::min(open_s_, then.open_s_);
  frozen_m_ = std::min(frozen_m_, then.frozen_m_);
  map_m_ = std::min(map_m_, then.map_m_);
}

// A speed that random accelerations change, integrated.
double UnmeasuredWay::open_m() const {
  return frozen_m_ + acceleration_mps2_ * std::sqrt(correlation_s * open_s_ * open_s_ * open_s_ / 3.0);
}

}  // namespace plumbline::slam
