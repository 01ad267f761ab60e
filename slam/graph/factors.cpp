// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/factors.h"

#include <Eigen/LU>
#include <cmath>

#include "bim/errors.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

namespace {

/// Trace of a wall at a fixed height: m.p + e = 0 with |m| = 1, and its change with the plane's increment.
struct PlaneTrace {
  Eigen::Vector2d m;
  double e = 0.0;
  Matrix23d dm;
  Eigen::RowVector3d de;
};

/// Change of (n, d) with the plane's increment.
struct PlaneChange {
  Eigen::Matrix3d dn;
};

PlaneChange change(const Plane& plane) {
  const Tangents t = plane_tangents(plane.n);
  PlaneChange c;
  c.dn << t.u, t.v, Eigen::Vector3d::Zero();
  return c;
}

const Eigen::RowVector3d change_of_d(0.0, 0.0, 1.0);

PlaneTrace cut(const Plane& plane, double z) {
  const Eigen::Vector2d xy = plane.n.head<2>();
  const double h = xy.norm();
  const double offset = plane.d + plane.n.z() * z;
  const Eigen::Matrix3d dn = change(plane).dn;
  PlaneTrace line;
  line.m = xy / h;
  line.e = offset / h;
  const Eigen::RowVector3d dh = line.m.transpose() * dn.topRows<2>();
  line.dm = (dn.topRows<2>() - line.m * dh) / h;
  line.de = (change_of_d + z * dn.row(2) - line.e * dh) / h;
  return line;
}

OpposedResidual between(const Eigen::Vector2d& c, const PlaneTrace& a, const PlaneTrace& b) {
  OpposedResidual r;
  r.e = 0.5 * ((a.m - b.m).dot(c) + a.e - b.e);
  r.J_center = 0.5 * (a.m - b.m).transpose();
  r.J_a = 0.5 * (c.transpose() * a.dm + a.de);
  r.J_b = -0.5 * (c.transpose() * b.dm + b.de);
  return r;
}

}  // namespace

Pose increment(const Pose& X, const Vector6d& step) {
  return {(X.q * exp_so3(step.tail<3>())).normalized(), X.t + X.q * step.head<3>()};
}

Plane increment(const Plane& plane, const Eigen::Vector3d& step) {
  const Tangents t = plane_tangents(plane.n);
  return {(plane.n + step.x() * t.u + step.y() * t.v).normalized(), plane.d + step.z()};
}

Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& w) {
  const double theta2 = w.squaredNorm();
  const Eigen::Matrix3d W = hat(w);
  // 1/theta^2 - (1 + cos theta) / (2 theta sin theta), which tends to 1/12 + theta^2/720.
  double k = 1.0 / 12.0 + theta2 / 720.0;
  if (theta2 > 1e-4) {
    const double theta = std::sqrt(theta2);
    k = 1.0 / theta2 - std::cos(0.5 * theta) / (2.0 * theta * std::sin(0.5 * theta));
  }
  return Eigen::Matrix3d::Identity() + 0.5 * W + k * W * W;
}

PoseResidual pose_residual(const Pose& X_Mi, const Pose& X_Mj, const Pose& X_ij) {
  const Pose predicted_ij = X_Mi.inverse() * X_Mj;
  const Pose error = X_ij.inverse() * predicted_ij;
  const Eigen::Matrix3d R_Z = X_ij.rotation();
  const Eigen::Matrix3d R_ij = predicted_ij.rotation();
  PoseResidual r;
  r.e << error.t, log_so3(error.q);
  const Eigen::Matrix3d J_inv = inverse_right_jacobian(r.e.tail<3>());
  r.J_i.setZero();
  r.J_i.topLeftCorner<3, 3>() = -R_Z.transpose();
  r.J_i.topRightCorner<3, 3>() = R_Z.transpose() * hat(predicted_ij.t);
  r.J_i.bottomRightCorner<3, 3>() = -J_inv * R_ij.transpose();
  r.J_j.setZero();
  r.J_j.topLeftCorner<3, 3>() = R_Z.transpose() * R_ij;
  r.J_j.bottomRightCorner<3, 3>() = J_inv;
  return r;
}

PlaneResidual plane_residual(const Pose& X_MR, const Plane& plane_M, const Plane& measured_R) {
  const Plane seen_R = X_MR.inverse() * plane_M;
  const Tangents t = plane_tangents(measured_R.n);
  Eigen::Matrix<double, 2, 3> T;
  T << t.u.transpose(), t.v.transpose();
  const Eigen::Matrix3d dn = change(plane_M).dn;
  PlaneResidual r;
  r.e << T * seen_R.n, seen_R.d - measured_R.d;
  r.J_pose.setZero();
  r.J_pose.topRightCorner<2, 3>() = T * hat(seen_R.n);
  r.J_pose.bottomLeftCorner<1, 3>() = seen_R.n.transpose();
  r.J_plane.topRows<2>() = T * X_MR.rotation().transpose() * dn;
  r.J_plane.bottomRows<1>() = X_MR.t.transpose() * dn + change_of_d;
  return r;
}

OpposedResidual opposed_residual(const Eigen::Vector2d& center_M, const Plane& a_M, const Plane& b_M, double z_M) {
  return between(center_M, cut(a_M, z_M), cut(b_M, z_M));
}

FourWallResidual four_wall_residual(const Eigen::Vector2d& center_M, const Plane* const planes_M[4], double z_M) {
  const OpposedResidual x = opposed_residual(center_M, *planes_M[0], *planes_M[1], z_M);
  const OpposedResidual y = opposed_residual(center_M, *planes_M[2], *planes_M[3], z_M);
  FourWallResidual r;
  r.e << x.e, y.e;
  r.J_center << x.J_center, y.J_center;
  const Eigen::RowVector3d zero = Eigen::RowVector3d::Zero();
  r.J_plane[0] << x.J_a, zero;
  r.J_plane[1] << x.J_b, zero;
  r.J_plane[2] << zero, y.J_a;
  r.J_plane[3] << zero, y.J_b;
  return r;
}

TwoWallResidual two_wall_residual(const Eigen::Vector2d& center_M, const Plane& a_M, const Plane& b_M,
                                  const Eigen::Vector2d& cluster_M, double z_M) {
  const PlaneTrace a = cut(a_M, z_M);
  const PlaneTrace b = cut(b_M, z_M);
  const OpposedResidual across = between(center_M, a, b);
  const Eigen::Vector2d sum = a.m - b.m;
  const double length = sum.norm();
  if (length < 1e-6) throw UndefinedResidual("two-wall room of two walls with the same normal");
  const Eigen::Vector2d n = sum / length;
  Eigen::Matrix2d turn;  // along = turn * n
  turn << 0.0, -1.0, 1.0, 0.0;
  const Eigen::Vector2d offset = center_M - cluster_M;
  const Eigen::RowVector2d d_along =
      offset.transpose() * turn * (Eigen::Matrix2d::Identity() - n * n.transpose()) / length;
  TwoWallResidual r;
  r.e << across.e, (turn * n).dot(offset);
  r.J_center << across.J_center, (turn * n).transpose();
  r.J_plane[0] << across.J_a, d_along * a.dm;
  r.J_plane[1] << across.J_b, -d_along * b.dm;
  return r;
}

PolygonResidual polygon_residual(const Eigen::Vector2d& center_M, std::span<const Plane> planes_M,
                                 std::span<const RoomCorner> corners, double z_M) {
  constexpr double least_sine = 1e-3;
  if (corners.empty()) throw InternalError("a polygon room without a corner");
  std::vector<PlaneTrace> lines;
  for (const Plane& plane : planes_M) lines.push_back(cut(plane, z_M));
  PolygonResidual r;
  r.J_center.setIdentity();
  r.J_plane.assign(planes_M.size(), Matrix23d::Zero());
  const double share = 1.0 / static_cast<double>(corners.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const RoomCorner& corner : corners) {
    Eigen::Matrix2d A;  // A p + (e_a, e_b) = 0
    for (int i = 0; i < 2; ++i) A.row(i) = lines[static_cast<std::size_t>(corner[static_cast<std::size_t>(i)])].m;
    if (std::abs(A.determinant()) < least_sine)
      throw UndefinedResidual("a polygon room's corner between parallel walls");
    const Eigen::Matrix2d inverse = A.inverse();
    const auto line = [&](int i) { return lines[static_cast<std::size_t>(corner[static_cast<std::size_t>(i)])]; };
    const Eigen::Vector2d p = -(inverse * Eigen::Vector2d(line(0).e, line(1).e));
    mean += share * p;
    for (int i = 0; i < 2; ++i)
      r.J_plane[static_cast<std::size_t>(corner[static_cast<std::size_t>(i)])] +=
          share * inverse.col(i) * (p.transpose() * line(i).dm + line(i).de);
  }
  r.e = center_M - mean;
  return r;
}

DuplicateResidual duplicate_residual(const Plane& a_M, const Plane& b_M, const Eigen::Vector3d& anchor_M) {
  const Eigen::Matrix3d dn_a = change(a_M).dn;
  const Eigen::Matrix3d dn_b = change(b_M).dn;
  DuplicateResidual r;
  r.e << b_M.n - a_M.n, b_M.distance(anchor_M) - a_M.distance(anchor_M);
  r.J_a << -dn_a, -(anchor_M.transpose() * dn_a + change_of_d);
  r.J_b << dn_b, anchor_M.transpose() * dn_b + change_of_d;
  return r;
}

Eigen::Vector2d floor_residual(const Eigen::Vector2d& floor_M, const Eigen::Vector2d& room_M,
                               const Eigen::Vector2d& offset_M) {
  return floor_M - room_M - offset_M;
}

}  // namespace plumbline::slam
