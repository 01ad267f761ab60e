// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/interpret.h"
#include "bim/formats/ifc/read/stair_recognition.h"
#include "bim/formats/ifc/read/storey_kinds.h"
#include "bim/geometry/interval.h"

namespace plumbline::bim {
namespace {

/// Storey whose floor lies within `below` under and `above` over a height: one with rooms, since some files have a
/// level more for the top of each slab; of those the nearest, of equal ones the lower; -1 none.
int storey_near(const Building& building, double z_m, double below_m, double above_m) {
  int best = -1;
  double nearest = 0.0;
  bool roomy = false;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    const double away = building.storeys[i].elevation_m - z_m;
    if (away < -below_m || away > above_m) continue;
    const bool rooms = has_room(building, static_cast<int>(i));
    if (best >= 0 && (rooms == roomy ? std::abs(away) >= nearest : roomy)) continue;
    best = static_cast<int>(i);
    nearest = std::abs(away);
    roomy = rooms;
  }
  return best;
}

/// Lowest and highest level of flights and landings.
struct Levels {
  double foot_m, head_m, rise_m;
};

Levels levels_of(const Stair& stair) {
  const StairFlight& first = stair.flights.front();
  const StairFlight& last = stair.flights.back();
  Levels levels{first.z0_m, last.z0_m + last.steps * last.rise_m, last.rise_m};
  for (const Landing& landing : stair.landings) {
    levels.foot_m = std::min(levels.foot_m, landing.z_m);
    levels.head_m = std::max(levels.head_m, landing.z_m);
  }
  return levels;
}

/// Whether the line from `low` to `high` over a point of the plan meets the body's surface.
bool meets(const Solid& body, const Eigen::Vector2d& p, const Interval& z) {
  return std::any_of(body.triangles.begin(), body.triangles.end(), [&](const Eigen::Vector3i& t) {
    const auto corner = [&](int k) -> const Eigen::Vector3d& { return body.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (std::abs(n.z()) < 1e-9) return false;
    const Polygon2 triangle = {corner(0).head<2>(), corner(1).head<2>(), corner(2).head<2>()};
    if (!contains(triangle, p)) return false;
    const double at = corner(0).z() - n.head<2>().dot(p - corner(0).head<2>()) / n.z();
    return at > z.low && at < z.high;
  });
}

/// The first slab that lies low over several steps of a stair; over one or two it may be the floor at its head.
const Slab* slab_over(const Stair& stair, const std::vector<Slab>& slabs, double headroom_m) {
  constexpr int least_steps = 3;
  constexpr double over_m = 0.05;
  for (const Slab& slab : slabs) {
    if (!slab.body) continue;
    int low = 0;
    for (const StairFlight& flight : stair.flights)
      for (int k = 0; k < flight.steps; ++k) {
        const Eigen::Vector2d ascent(std::cos(flight.yaw), std::sin(flight.yaw));
        const double tread_m = flight.z0_m + (k + 1) * flight.rise_m;
        const Interval room{tread_m + over_m, tread_m + headroom_m};
        if (slab.z1_m < room.low || slab.z0_m > room.high) continue;
        low += meets(*slab.body, flight.start + (k + 0.5) * flight.run_m * ascent, room) ? 1 : 0;
      }
    if (low >= least_steps) return &slab;
  }
  return nullptr;
}

}  // namespace

/// Stairs with all their flights and landings; a flight that belongs to no stair is one. Railings stand for themselves.
void Interpreter::add_stairs() {
  for (const StepProduct& product : model_.products) {
    const bool lone_flight = product.kind == StepClass::stair_flight && !within(product, StepClass::stair);
    if (product.kind != StepClass::stair && !lone_flight) continue;
    const StepProduct* const whole = find(product.whole);
    if (whole != nullptr && within(*whole, StepClass::stair)) continue;
    Stair stair;
    stair.id = product.id;
    stair.name = product.name;
    stair.step_id = product.step_id;
    stair.material = product.material;
    add_stair_bodies(product, stair);
    if (stair.bodies.empty()) {
      warn(product, "no_body", "has no body that can be read, and is left out");
      continue;
    }
    RecognizedStair shape = recognize_stair(stair.bodies);
    stair.flights = std::move(shape.flights);
    stair.landings = std::move(shape.landings);
    place_stair(product, stair);
    building_.stairs.push_back(std::move(stair));
  }
}

void Interpreter::add_stair_bodies(const StepProduct& product, Stair& stair) {
  for (Solid& solid : solids_of(product)) stair.bodies.push_back(std::move(solid));
  if (stair.material.empty()) stair.material = product.material;
  const auto parts = parts_.find(product.step_id);
  if (parts == parts_.end()) return;
  for (const StepProduct* part : parts->second) {
    if (part->kind == StepClass::obstacle && obstacle_kind(part->type) == "railing") continue;
    taken_.insert(part->step_id);
    add_stair_bodies(*part, stair);
  }
}

void Interpreter::place_stair(const StepProduct& product, Stair& stair) {
  double foot_m = extent(joined(stair.bodies)).low.z();
  stair.from = storey_index(product, foot_m);
  if (stair.flights.empty()) {
    warn(product, "no_flights", "no steps were found in its body; it is solid, not walkable");
    return;
  }
  const Levels levels = levels_of(stair);
  const int from = storey_near(building_, levels.foot_m, config_.stair_reach_m, config_.stair_foot_m);
  // The last riser may lead from the last tread to the floor.
  const int to = storey_near(building_, levels.head_m, config_.stair_reach_m, levels.rise_m + config_.stair_reach_m);
  if (from >= 0) stair.from = from;
  if (to < 0) {
    warn(product, "stair_ends", "its head reaches the floor of no storey");
  } else if (from >= 0 && to == from) {
    warn(product, "stair_within", "leads from and to the same storey");
  }
  stair.to = to;
  if (const Slab* slab = slab_over(stair, building_.slabs, config_.headroom_m)) {
    stair.to = -1;
    warn(product, "no_headroom",
         "slab " + slab->id + " lies less than " + format_number(config_.headroom_m) +
             " m over its steps and has no opening there; it is no way");
  }
}

}  // namespace plumbline::bim
