// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/geometry/plane.h"

/// Other ways to write a plane down, as the S-Graphs papers and their code do, and back.
namespace plumbline::slam {

/// Closest-point form: the foot of the frame's origin on the plane, -d n, m. It cannot tell the two sides apart and is
/// zero for every plane through the origin [facts: slam 1.4], so the graph does not use it.
[[nodiscard]] Eigen::Vector3d closest_point(const Plane& plane);
/// The plane with that foot, its normal towards the origin (d > 0). Throws InternalError at the origin itself.
[[nodiscard]] Plane from_closest_point(const Eigen::Vector3d& foot);

/// Minimal form [S-Graphs+ section IV-B]: angles of the normal, rad, and offset, m; n.p + d = 0.
struct AnglePlane {
  double azimuth = 0.0;    ///< in (-pi, pi]; 0 where the normal is vertical
  double elevation = 0.0;  ///< in [-pi/2, pi/2]
  double d = 0.0;
};
[[nodiscard]] AnglePlane to_angles(const Plane& plane);
[[nodiscard]] Plane from_angles(const AnglePlane& plane);

/// How b differs from a in a's own angles [facts: slam 3.1]: azimuth and elevation of b's normal as seen along a's,
/// rad, and d_b - d_a, m. Zero if and only if the planes are equal.
[[nodiscard]] Eigen::Vector3d angle_difference(const Plane& a, const Plane& b);

/// Largest component of a normal in M [S-Graphs+ section IV-B].
enum class PlaneAxis { x, y, horizontal };
/// Ties: x before y before horizontal.
[[nodiscard]] PlaneAxis axis_of(const Eigen::Vector3d& n_M);

}  // namespace plumbline::slam
