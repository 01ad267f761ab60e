// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/geometry/plane.h"

/// Parametrizations of planes, as in the S-Graphs papers and their code.
namespace plumbline::slam {

/// Minimal form [bavle2023, section IV-B]: angles of the normal, rad, and offset, m; n.p + d = 0.
struct AnglePlane {
  double azimuth = 0.0;    ///< in (-pi, pi]; 0 where the normal is vertical
  double elevation = 0.0;  ///< in [-pi/2, pi/2]
  double d = 0.0;
};
[[nodiscard]] AnglePlane to_angles(const Plane& plane);

/// How b differs from a in a's own angles [lsg2022]: azimuth and elevation of b's normal as seen along a's, rad, and
/// d_b - d_a, m. Zero if and only if the planes are equal.
[[nodiscard]] Eigen::Vector3d angle_difference(const Plane& a, const Plane& b);

/// Largest component of a normal in M [bavle2023, section IV-B].
enum class PlaneAxis { x, y, horizontal };
/// Ties: x before y before horizontal.
[[nodiscard]] PlaneAxis axis_of(const Eigen::Vector3d& n_M);

}  // namespace plumbline::slam
