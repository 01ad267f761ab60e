// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_gaps.h"

#include <cmath>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

void OdometryGaps::add(const slam::SensorFrame& frame) {
  constexpr slam::Nanoseconds old = 500'000'000;  // half a metre or more of a walk
  if (!frame.odometry.empty()) newest_ = frame.odometry.back().stamp;
  ++scans_;
  ended_ = !newest_ || frame.scan.stamp - *newest_ > old;
  if (!ended_) return;
  if (!first_) first_ = frame.scan.stamp;
  ++without_;
}

std::optional<std::string> OdometryGaps::warning() const {
  if (without_ == 0) return std::nullopt;
  const double first_s = std::round(10.0 * slam::seconds(*first_)) / 10.0;
  return "odometry is more than 0.5 s old at " + std::to_string(without_) + " of " + std::to_string(scans_) +
         " scans, first at " + format_number(first_s) + " s" + (ended_ ? ", and ends before the last scan" : "");
}

}  // namespace plumbline::scenarios
