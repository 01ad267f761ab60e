// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/moments.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bim/geometry/symmetric.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

namespace {

using Matrix34d = Eigen::Matrix<double, 3, 4>;

/// Rows: u, v and the constant, so that J^T = rows * (p, 1).
Matrix34d jacobian_rows(const Plane& plane) {
  const Tangents t = plane_tangents(plane.n);
  Matrix34d rows = Matrix34d::Zero();
  rows.row(0).head<3>() = t.u;
  rows.row(1).head<3>() = t.v;
  rows(2, 3) = 1.0;
  return rows;
}

/// Sum of (p, 1)(p, 1)^T.
Eigen::Matrix4d homogeneous(const Moments& m) {
  Eigen::Matrix4d g;
  g << m.outer, m.sum, m.sum.transpose(), m.n;
  return g;
}

}  // namespace

Eigen::Matrix3d plane_normal_matrix(const Moments& moments, const Plane& plane) {
  const Matrix34d rows = jacobian_rows(plane);
  return rows * homogeneous(moments) * rows.transpose();
}

Plane refine_plane(const Moments& moments, const Plane& plane, double tilt_weight) {
  const Matrix34d rows = jacobian_rows(plane);
  const Eigen::Matrix4d g = homogeneous(moments);
  Eigen::Vector4d coefficients;
  coefficients << plane.n, plane.d;
  Eigen::Matrix3d h = rows * g * rows.transpose();
  Eigen::Vector3d b = rows * (g * coefficients);
  // d n_z / d(angle towards v) is v_z.
  const double v_z = rows(1, 2);
  h(1, 1) += tilt_weight * v_z * v_z;
  b(1) += tilt_weight * v_z * plane.n.z();
  const Eigen::Vector3d step = -solve_ldlt(h, b);
  const Eigen::Vector3d n =
      plane.n + rows.row(0).head<3>().transpose() * step(0) + rows.row(1).head<3>().transpose() * step(1);
  const double norm = n.norm();
  return {n / norm, (plane.d + step(2)) / norm};
}

double plane_rms(const Moments& moments, const Plane& plane) {
  Eigen::Vector4d coefficients;
  coefficients << plane.n, plane.d;
  return std::sqrt(std::max(0.0, coefficients.dot(homogeneous(moments) * coefficients)) / moments.n);
}

Eigen::Matrix3d plane_covariance(const Moments& moments, const Plane& plane, double sigma,
                                 const Eigen::Vector3d& bias) {
  const Tangents t = plane_tangents(plane.n);
  const Eigen::Vector3d c = moments.mean();
  Eigen::Matrix3d at_centroid = Eigen::Matrix3d::Identity();  // an angle about the centroid moves d by -(u.c) or -(v.c)
  at_centroid(2, 0) = -t.u.dot(c);
  at_centroid(2, 1) = -t.v.dot(c);
  return sigma * sigma * plane_normal_matrix(moments, plane).inverse() +
         at_centroid * bias.cwiseAbs2().asDiagonal() * at_centroid.transpose();
}

}  // namespace plumbline::slam
