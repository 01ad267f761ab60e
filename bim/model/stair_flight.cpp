// SPDX-License-Identifier: Apache-2.0
#include "bim/model/stair_flight.h"

#include <cmath>

namespace plumbline::bim {

Eigen::Vector2d ascent(const StairFlight& flight) { return {std::cos(flight.yaw), std::sin(flight.yaw)}; }

Polygon2 steps_outline(const StairFlight& flight, int first, int last) {
  const Eigen::Vector2d e = ascent(flight), left(-e.y(), e.x());
  const double s0 = first * flight.run_m, s1 = (last + 1) * flight.run_m;
  const double t0 = -0.5 * flight.width_m, t1 = 0.5 * flight.width_m;
  return {flight.start + s0 * e + t0 * left, flight.start + s1 * e + t0 * left, flight.start + s1 * e + t1 * left,
          flight.start + s0 * e + t1 * left};
}

Eigen::Vector2d head_of(const StairFlight& flight, double beyond_m) {
  return flight.start + (flight.steps * flight.run_m + beyond_m) * ascent(flight);
}

}  // namespace plumbline::bim
