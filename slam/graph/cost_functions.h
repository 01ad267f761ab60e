// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <array>

#include "slam/graph/graph.h"

/// The residuals of factors.h as Ceres cost functions; included by sources of slam/graph only, since it includes Ceres.
namespace plumbline::slam {

using PoseBlock = std::array<double, 7>;   ///< quaternion (x, y, z, w), translation
using PlaneBlock = std::array<double, 4>;  ///< normal, offset
using CenterBlock = std::array<double, 2>;

[[nodiscard]] PoseBlock to_block(const Pose& X);
[[nodiscard]] PlaneBlock to_block(const Plane& plane);
[[nodiscard]] Pose to_pose(const double* block);
[[nodiscard]] Plane to_plane(const double* block);

/// Manifold whose cost functions give Jacobians in the tangent space already: a cost writes them into the first columns
/// of the ambient Jacobian, and PlusJacobian is (I, 0)^T.
class TangentManifold : public ceres::Manifold {
 public:
  TangentManifold(int ambient, int tangent) : ambient_(ambient), tangent_(tangent) {}
  [[nodiscard]] int AmbientSize() const override { return ambient_; }
  [[nodiscard]] int TangentSize() const override { return tangent_; }
  bool PlusJacobian(const double* x, double* jacobian) const override;
  /// Not needed by the solver.
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  int ambient_, tangent_;
};

/// X <- increment(X, step).
class PoseManifold : public TangentManifold {
 public:
  PoseManifold() : TangentManifold(7, 6) {}
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
};

/// plane <- increment(plane, step).
class PlaneManifold : public TangentManifold {
 public:
  PlaneManifold() : TangentManifold(4, 3) {}
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
};

/// Whitened costs; the caller owns them. Blocks: (from, to), (keyframe, plane), (room, planes...), (floor, room), (a,
/// b).
[[nodiscard]] ceres::CostFunction* pose_cost(const PoseFactor& factor);
[[nodiscard]] ceres::CostFunction* plane_cost(const PlaneFactor& factor);
[[nodiscard]] ceres::CostFunction* room_cost(const RoomFactor& factor);
[[nodiscard]] ceres::CostFunction* floor_cost(const FloorFactor& factor);
[[nodiscard]] ceres::CostFunction* duplicate_cost(const DuplicateFactor& factor);

}  // namespace plumbline::slam
