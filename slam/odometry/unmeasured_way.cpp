// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/unmeasured_way.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

/// What a robot or person accelerates by in passing, and for how long.
constexpr double acceleration_mps2 = 2.0, correlation_s = 0.1;

}  // namespace

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

// A speed that random accelerations change, integrated.
double UnmeasuredWay::open_m() const {
  return frozen_m_ + acceleration_mps2 * std::sqrt(correlation_s * open_s_ * open_s_ * open_s_ / 3.0);
}

}  // namespace plumbline::slam
