// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/plane_observation.h"

#include <cmath>

namespace plumbline::slam {

namespace {

// Above this |n_z| the horizontal tangent of a normal is ill-conditioned.
constexpr double max_wall_nz = 0.9;

}  // namespace

Tangents plane_tangents(const Eigen::Vector3d& n) {
  const Eigen::Vector3d up =
      std::abs(n.z()) <= max_wall_nz ? Eigen::Vector3d::UnitZ().eval() : Eigen::Vector3d::UnitY().eval();
  const Eigen::Vector3d u = up.cross(n).normalized();
  return {u, n.cross(u)};
}

}  // namespace plumbline::slam
