// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/forms.h"

#include <cmath>

namespace plumbline::slam {

namespace {

double elevation_of(const Eigen::Vector3d& n) { return std::atan2(n.z(), n.head<2>().norm()); }

double azimuth_of(const Eigen::Vector3d& n) { return n.head<2>().isZero(0.0) ? 0.0 : std::atan2(n.y(), n.x()); }

}  // namespace

AnglePlane to_angles(const Plane& plane) { return {azimuth_of(plane.n), elevation_of(plane.n), plane.d}; }

Eigen::Vector3d angle_difference(const Plane& a, const Plane& b) {
  const double azimuth = azimuth_of(a.n), elevation = elevation_of(a.n);
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation), se = std::sin(elevation);
  // R(n) = Rz(azimuth) Ry(-elevation) turns the x axis into n.
  Eigen::Matrix3d R;
  R << ca * ce, -sa, -ca * se, sa * ce, ca, -sa * se, se, 0.0, ce;
  const Eigen::Vector3d n = R.transpose() * b.n;
  return {azimuth_of(n), elevation_of(n), b.d - a.d};
}

PlaneAxis axis_of(const Eigen::Vector3d& n_M) {
  const Eigen::Vector3d size = n_M.cwiseAbs();
  if (size.x() >= size.y() && size.x() >= size.z()) return PlaneAxis::x;
  return size.y() >= size.z() ? PlaneAxis::y : PlaneAxis::horizontal;
}

}  // namespace plumbline::slam
