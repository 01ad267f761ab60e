// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "bim/geometry/plane.h"
#include "bim/random/stream.h"

namespace plumbline::slam {

/// Random values for laws, one set a tick.
struct RandomValues {
  Stream stream;
  std::uint64_t tick = 0;
  std::uint32_t draw = 0;

  RandomValues(std::uint64_t seed, std::uint64_t at) : stream(seed, "bim.generate"), tick(at) {}

  double gauss() { return stream.gauss(tick, 0, draw++); }
  double uniform(double a, double b) { return a + (b - a) * stream.uniform(tick, 1, draw++); }
  Eigen::Vector3d vector(double sigma) {
    const double x = sigma * gauss(), y = sigma * gauss(), z = sigma * gauss();
    return {x, y, z};
  }
  Pose pose(double sigma_m, double sigma_rad) {
    const Eigen::Vector3d w = vector(sigma_rad);
    return {exp_so3(w), vector(sigma_m)};
  }
  /// A nearly vertical plane whose normal points along yaw.
  Plane wall(double yaw, double d) {
    const Eigen::Vector3d n(std::cos(yaw), std::sin(yaw), 0.02 * gauss());
    return {n.normalized(), d};
  }
  Vector6d twist(double sigma) {
    Vector6d v;
    for (int i = 0; i < 6; ++i) v(i) = sigma * gauss();
    return v;
  }
};

}  // namespace plumbline::slam
