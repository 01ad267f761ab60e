// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "slam/planes/forms.h"

/// Forms of a plane that only tests need.
namespace plumbline::slam {

/// The foot of the frame's origin on the plane, -d n, m.
inline Eigen::Vector3d closest_point(const Plane& plane) { return -plane.d * plane.n; }

/// Inverse of to_angles().
inline Plane from_angles(const AnglePlane& plane) {
  const double level = std::cos(plane.elevation);
  return {{level * std::cos(plane.azimuth), level * std::sin(plane.azimuth), std::sin(plane.elevation)}, plane.d};
}

}  // namespace plumbline::slam
