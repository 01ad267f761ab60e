// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/geometry/pose.h"

namespace plumbline {

/// Oriented plane n.x + d = 0 with |n| = 1. A wall face's normal points out of the wall, into free space; an observed
/// plane's normal points to the sensor.
struct Plane {
  Eigen::Vector3d n = Eigen::Vector3d::UnitZ();
  double d = 0.0;

  /// Signed distance of a point, m, positive on the side n points to.
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const { return n.dot(p) + d; }
  [[nodiscard]] Plane flipped() const { return {-n, -d}; }
};

/// The same plane expressed in A: n_A = R_AB n_B, d_A = d_B - t_AB . n_A.
[[nodiscard]] inline Plane operator*(const Pose& X_AB, const Plane& plane_B) {
  const Eigen::Vector3d n_A = X_AB.q * plane_B.n;
  return {n_A, plane_B.d - X_AB.t.dot(n_A)};
}

}  // namespace plumbline
