// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/geometry/plane.h"

namespace plumbline::slam {

/// A planar patch seen in one scan, in R at the scan's stamp, kept as parameters, moments and extent.
struct PlaneObservation {
  Plane plane_R;                ///< normal towards the sensor
  Eigen::Matrix3d covariance =  ///< of (angle of n towards u, angle towards v, d), rad, rad, m; u, v: plane_tangents()
      Eigen::Matrix3d::Identity();
  int points = 0;
  double rms_m = 0.0;  ///< rms distance of the points
  Eigen::Vector3d centroid_R = Eigen::Vector3d::Zero();
  Eigen::Vector3d p0_R = Eigen::Vector3d::Zero();  ///< ends of the patch along its longer horizontal direction
  Eigen::Vector3d p1_R = Eigen::Vector3d::Zero();
  double z0 = 0.0;  ///< lowest and highest point along R's z
  double z1 = 0.0;
  bool vertical = false;  ///< a wall; else horizontal (floor, ceiling)
};

/// Two unit tangents (u, v) of a normal, a fixed smooth choice: u horizontal where n is not vertical.
struct Tangents {
  Eigen::Vector3d u, v;
};
[[nodiscard]] Tangents plane_tangents(const Eigen::Vector3d& n);

}  // namespace plumbline::slam
