// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bim/errors.h"
#include "bim/geometry/plane.h"
#include "slam/graph/graph.h"

/// Residuals of the situational graph with analytic Jacobians. Increments:
///   pose  X <- X * (rho, phi):  t <- t + R rho, R <- R exp(phi)   (6)
///   plane (n, d) <- (n + a u + b v, d + c), normalised            (3), (u, v) = plane_tangents(n)
///   centre c <- c + (x, y)                                        (2)
namespace plumbline::slam {

using Matrix36d = Eigen::Matrix<double, 3, 6>;
using Matrix23d = Eigen::Matrix<double, 2, 3>;

[[nodiscard]] Pose increment(const Pose& X, const Vector6d& step);
[[nodiscard]] Plane increment(const Plane& plane, const Eigen::Vector3d& step);

/// Inverse of the right Jacobian of SO(3): d log(exp(w) exp(x)) / dx at x = 0.
[[nodiscard]] Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& w);

struct PoseResidual {
  Vector6d e;  ///< translation (m) and rotation vector (rad) of Z^-1 X_i^-1 X_j
  Matrix6d J_i, J_j;
};
/// Odometry and loop closure.
[[nodiscard]] PoseResidual pose_residual(const Pose& X_Mi, const Pose& X_Mj, const Pose& X_ij);

struct PlaneResidual {
  Eigen::Vector3d e;  ///< two tangential components of the normal, offset (m), all in R
  Matrix36d J_pose;
  Eigen::Matrix3d J_plane;
};
/// Plane seen from a pose. Compared in the sensor's frame, so that the choice of M's origin does not enter.
[[nodiscard]] PlaneResidual plane_residual(const Pose& X_MR, const Plane& plane_M, const Plane& measured_R);

struct OpposedResidual {
  double e;  ///< half the difference of the centre's distances to the two walls, m
  Eigen::RowVector2d J_center;
  Eigen::RowVector3d J_a, J_b;
};
/// One axis of a room: its centre stands midway between two opposed walls, cut at height z_M. Equals n.c - (o1 + o2) /
/// 2 of [bavle2023, eq. 4] for parallel walls, but for any walls it is free of the map's origin and nowhere singular.
[[nodiscard]] OpposedResidual opposed_residual(const Eigen::Vector2d& center_M, const Plane& a_M, const Plane& b_M,
                                               double z_M);

struct FourWallResidual {
  Eigen::Vector2d e;
  Eigen::Matrix2d J_center;
  Matrix23d J_plane[4];
};
/// [bavle2023, eq. 7]: planes x_a, x_b, y_a, y_b.
[[nodiscard]] FourWallResidual four_wall_residual(const Eigen::Vector2d& center_M, const Plane* const planes_M[4],
                                                  double z_M);

/// A residual without a value: walls that should meet or face each other are parallel or alike. An optimizer does not
/// go there.
class UndefinedResidual : public InternalError {
  using InternalError::InternalError;
};

struct TwoWallResidual {
  Eigen::Vector2d e;  ///< across the walls, along them from the cluster's centre; m
  Eigen::Matrix2d J_center;
  Matrix23d J_plane[2];
};
/// [bavle2023, eq. 5, 8], cluster_M constant. Throws UndefinedResidual when the walls are not opposed at all (equal
/// normals).
[[nodiscard]] TwoWallResidual two_wall_residual(const Eigen::Vector2d& center_M, const Plane& a_M, const Plane& b_M,
                                                const Eigen::Vector2d& cluster_M, double z_M);

struct PolygonResidual {
  Eigen::Vector2d e;  ///< centre less the mean of the corners, m
  Eigen::Matrix2d J_center;
  std::vector<Matrix23d> J_plane;  ///< in the order of planes_M
};
/// A room of any shape: its centre is the mean of the corners in which its walls meet, cut at height z_M. Moves with
/// the walls, wherever the map's origin is. Throws InternalError when there is no corner, UndefinedResidual when
/// a corner's walls are parallel.
[[nodiscard]] PolygonResidual polygon_residual(const Eigen::Vector2d& center_M, std::span<const Plane> planes_M,
                                               std::span<const RoomCorner> corners, double z_M);

struct DuplicateResidual {
  Eigen::Vector4d e;  ///< difference of the normals, difference of the distances of the anchor (m)
  Eigen::Matrix<double, 4, 3> J_a, J_b;
};
/// Two vertices of one wall face, compared at a point on them.
[[nodiscard]] DuplicateResidual duplicate_residual(const Plane& a_M, const Plane& b_M, const Eigen::Vector3d& anchor_M);

/// [bavle2023, eq. 9]: deviation of a room from its place on the floor; Jacobians are I and -I.
[[nodiscard]] Eigen::Vector2d floor_residual(const Eigen::Vector2d& floor_M, const Eigen::Vector2d& room_M,
                                             const Eigen::Vector2d& offset_M);

}  // namespace plumbline::slam
