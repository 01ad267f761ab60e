// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/stair_builder.h"

#include <cmath>
#include <numbers>

#include "bim/config/tree.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/model/extrude.h"
#include "bim/model/stair_flight.h"

namespace plumbline::bim {

namespace {

constexpr double max_steps = 1000;
constexpr double steps_slack = 1e-9;  ///< a height that is a multiple of rise_m needs no further step

Eigen::Vector2d left_of(const Eigen::Vector2d& e) { return {-e.y(), e.x()}; }

/// Rectangle from s0 to s1 along e and from t0 to t1 to its left.
Polygon2 rectangle(const Eigen::Vector2d& origin, const Eigen::Vector2d& e, double s0, double s1, double t0,
                   double t1) {
  const Eigen::Vector2d left = left_of(e);
  return {origin + s0 * e + t0 * left, origin + s1 * e + t0 * left, origin + s1 * e + t1 * left,
          origin + s0 * e + t1 * left};
}

/// Side view of a flight in (s, z): steps above, a sloping soffit below, cut off at `base`.
Polygon2 profile(const StairFlight& flight, double base, const StairBuilderConfig& config) {
  const double pitch = flight.rise_m / flight.run_m;
  const double below = config.waist_m * std::sqrt(1.0 + pitch * pitch);
  const double length = flight.steps * flight.run_m;
  const auto soffit = [&](double s) { return flight.z0_m + pitch * s - below; };
  Polygon2 outline = {{0.0, base}};
  const double soffit_from = (base - flight.z0_m + below) / pitch;  // where the soffit leaves the base
  if (soffit_from < length) {
    if (soffit_from > 0.0) outline.emplace_back(soffit_from, base);
    outline.emplace_back(length, soffit(length));
  } else {
    outline.emplace_back(length, base);
  }
  for (int k = flight.steps - 1; k >= 0; --k) {
    const double z = flight.z0_m + (k + 1) * flight.rise_m;
    outline.emplace_back((k + 1) * flight.run_m, z);
    outline.emplace_back(k * flight.run_m, z);
  }
  return outline;
}

Solid flight_body(const StairFlight& flight, double base, const StairBuilderConfig& config) {
  const Eigen::Vector2d e = ascent(flight);
  const auto at = [&](double t) {
    return [&flight, e, t](const Eigen::Vector2d& p) {
      const Eigen::Vector2d q = flight.start + p.x() * e + t * left_of(e);
      return Eigen::Vector3d(q.x(), q.y(), p.y());
    };
  };
  // Along the ascent, then up, is counter-clockwise seen from the right.
  return extrude_between({{profile(flight, base, config), {}}}, at(0.5 * flight.width_m), at(-0.5 * flight.width_m));
}

/// The landing at the head of the first flight, and the flight that goes on from it.
void turn_at_landing(const PlanStairEntry& entry, int steps_left, Stair& stair) {
  const StairFlight& first = stair.flights.front();
  const double width = entry.width_m, depth = entry.landing_m.value_or(width);
  const Eigen::Vector2d e = ascent(first), left = left_of(e), edge = head_of(first, 0.0);
  StairFlight second = first;
  second.steps = steps_left;
  second.z0_m = first.z0_m + first.steps * first.rise_m;
  double t0 = -0.5 * width, t1 = 0.5 * width;
  const double quarter = 0.5 * std::numbers::pi;
  switch (entry.turn) {
    case Turn::none:
      second.start = edge + depth * e;
      break;
    case Turn::left:
    case Turn::right: {
      const double side = entry.turn == Turn::left ? 1.0 : -1.0;
      second.start = edge + 0.5 * depth * e + side * 0.5 * width * left;
      second.yaw = first.yaw + side * quarter;
      break;
    }
    case Turn::back_left:
    case Turn::back_right: {
      const double side = entry.turn == Turn::back_left ? 1.0 : -1.0;
      second.start = edge + side * (width + entry.gap_m) * left;
      second.yaw = first.yaw + side * 2.0 * quarter;
      (side > 0.0 ? t1 : t0) += side * (width + entry.gap_m);
      break;
    }
  }
  stair.landings.push_back({rectangle(edge, e, 0.0, depth, t0, t1), second.z0_m});
  stair.flights.push_back(second);
}

}  // namespace

double step_count(double height_m, double rise_m) { return std::ceil(height_m / rise_m - steps_slack); }

std::optional<std::string> step_fault(const PlanStairEntry& entry, double height_m) {
  const double steps = step_count(height_m, entry.rise_m);
  if (!(steps >= 1.0)) return "does not lead up";
  if (steps > max_steps)
    return "would have " + format_number(steps) + " steps; at most " + format_number(max_steps) + " can be built";
  if (entry.landing_after && *entry.landing_after >= steps)
    return "has only " + format_number(steps) + " steps; its landing must come before the last";
  return std::nullopt;
}

Stair build_stair(const PlanStairEntry& entry, double z0_m, double height_m, const StairBuilderConfig& config) {
  Stair stair;
  stair.id = entry.id;
  stair.name = entry.id;
  stair.material = entry.material;
  const int steps = static_cast<int>(step_count(height_m, entry.rise_m));
  StairFlight flight;
  flight.start = entry.start;
  flight.yaw = entry.yaw_deg * std::numbers::pi / 180.0;
  flight.width_m = entry.width_m;
  flight.z0_m = z0_m;
  flight.steps = entry.landing_after.value_or(steps);
  flight.rise_m = height_m / steps;
  flight.run_m = entry.run_m;
  stair.flights.push_back(flight);
  if (entry.landing_after) turn_at_landing(entry, steps - *entry.landing_after, stair);
  for (const StairFlight& part : stair.flights)
    stair.bodies.push_back(flight_body(part, part.z0_m - (part.z0_m > z0_m ? config.landing_m : 0.0), config));
  for (const Landing& landing : stair.landings)
    stair.bodies.push_back(extrude({{landing.polygon, {}}}, landing.z_m - config.landing_m, landing.z_m));
  return stair;
}

}  // namespace plumbline::bim
