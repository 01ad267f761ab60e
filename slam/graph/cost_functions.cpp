// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/cost_functions.h"

#include <Eigen/Cholesky>

#include "bim/errors.h"
#include "slam/graph/factors.h"

namespace plumbline::slam {

namespace {

using Eigen::Map;

template <int N>
using Square = Eigen::Matrix<double, N, N>;

/// Upper triangular S with S^T S = information, so that |S e|^2 = e^T information e.
template <int N>
Square<N> square_root(const Square<N>& information) {
  const Eigen::LLT<Square<N>> llt(information);
  if (llt.info() != Eigen::Success) throw InternalError("information matrix of a factor is not positive definite");
  return llt.matrixU();
}

/// Writes a tangent-space Jacobian into the first columns of an ambient one.
template <int Rows, int Ambient, class Derived>
void write(double* jacobian, const Eigen::MatrixBase<Derived>& tangent) {
  Map<Eigen::Matrix<double, Rows, Ambient, Eigen::RowMajor>> J(jacobian);
  J.setZero();
  J.template leftCols<Derived::ColsAtCompileTime>() = tangent;
}

class PoseCost : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  explicit PoseCost(const PoseFactor& f) : X_FT_(f.X_FT), root_(square_root<6>(f.information)) {}
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    const PoseResidual r = pose_residual(to_pose(x[0]), to_pose(x[1]), X_FT_);
    Map<Vector6d>{e} = root_ * r.e;
    if (J != nullptr && J[0] != nullptr) write<6, 7>(J[0], root_ * r.J_i);
    if (J != nullptr && J[1] != nullptr) write<6, 7>(J[1], root_ * r.J_j);
    return true;
  }

 private:
  Pose X_FT_;
  Matrix6d root_;
};

class PlaneCost : public ceres::SizedCostFunction<3, 7, 4> {
 public:
  explicit PlaneCost(const PlaneFactor& f) : plane_R_(f.plane_R), root_(square_root<3>(f.information)) {}
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    const PlaneResidual r = plane_residual(to_pose(x[0]), to_plane(x[1]), plane_R_);
    Map<Eigen::Vector3d>{e} = root_ * r.e;
    if (J != nullptr && J[0] != nullptr) write<3, 7>(J[0], root_ * r.J_pose);
    if (J != nullptr && J[1] != nullptr) write<3, 4>(J[1], root_ * r.J_plane);
    return true;
  }

 private:
  Plane plane_R_;
  Eigen::Matrix3d root_;
};

class FourWallCost : public ceres::SizedCostFunction<2, 2, 4, 4, 4, 4> {
 public:
  explicit FourWallCost(const RoomFactor& f) : z_M_(f.height_M), root_(square_root<2>(f.information)) {}
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    const Plane planes[4] = {to_plane(x[1]), to_plane(x[2]), to_plane(x[3]), to_plane(x[4])};
    const Plane* const pointers[4] = {&planes[0], &planes[1], &planes[2], &planes[3]};
    const FourWallResidual r = four_wall_residual(Map<const Eigen::Vector2d>(x[0]), pointers, z_M_);
    Map<Eigen::Vector2d>{e} = root_ * r.e;
    if (J == nullptr) return true;
    if (J[0] != nullptr) write<2, 2>(J[0], root_ * r.J_center);
    for (int i = 0; i < 4; ++i)
      if (J[i + 1] != nullptr) write<2, 4>(J[i + 1], root_ * r.J_plane[i]);
    return true;
  }

 private:
  double z_M_;
  Eigen::Matrix2d root_;
};

/// False where a residual has no value, which tells an optimizer to step back.
template <class Evaluate>
bool is_defined(const Evaluate& evaluate) {
  try {
    evaluate();
  } catch (const UndefinedResidual&) {
    return false;
  }
  return true;
}

class TwoWallCost : public ceres::SizedCostFunction<2, 2, 4, 4> {
 public:
  explicit TwoWallCost(const RoomFactor& f)
      : cluster_M_(f.cluster_M), z_M_(f.height_M), root_(square_root<2>(f.information)) {}
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    return is_defined([&] { evaluate(x, e, J); });
  }

 private:
  void evaluate(double const* const* x, double* e, double** J) const {
    const TwoWallResidual r =
        two_wall_residual(Map<const Eigen::Vector2d>(x[0]), to_plane(x[1]), to_plane(x[2]), cluster_M_, z_M_);
    Map<Eigen::Vector2d>{e} = root_ * r.e;
    if (J == nullptr) return;
    if (J[0] != nullptr) write<2, 2>(J[0], root_ * r.J_center);
    for (int i = 0; i < 2; ++i)
      if (J[i + 1] != nullptr) write<2, 4>(J[i + 1], root_ * r.J_plane[i]);
  }

  Eigen::Vector2d cluster_M_;
  double z_M_;
  Eigen::Matrix2d root_;
};

class PolygonCost : public ceres::CostFunction {
 public:
  explicit PolygonCost(const RoomFactor& f)
      : corners_(f.corners), z_M_(f.height_M), root_(square_root<2>(f.information)), walls_(f.planes.size()) {
    set_num_residuals(2);
    mutable_parameter_block_sizes()->push_back(2);
    for (std::size_t i = 0; i < walls_; ++i) mutable_parameter_block_sizes()->push_back(4);
  }
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    return is_defined([&] { evaluate(x, e, J); });
  }

 private:
  void evaluate(double const* const* x, double* e, double** J) const {
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < walls_; ++i) planes.push_back(to_plane(x[i + 1]));
    const PolygonResidual r = polygon_residual(Map<const Eigen::Vector2d>(x[0]), planes, corners_, z_M_);
    Map<Eigen::Vector2d>{e} = root_ * r.e;
    if (J == nullptr) return;
    if (J[0] != nullptr) write<2, 2>(J[0], root_ * r.J_center);
    for (std::size_t i = 0; i < walls_; ++i)
      if (J[i + 1] != nullptr) write<2, 4>(J[i + 1], root_ * r.J_plane[i]);
  }

  std::vector<RoomCorner> corners_;
  double z_M_;
  Eigen::Matrix2d root_;
  std::size_t walls_;
};

class FloorCost : public ceres::SizedCostFunction<2, 2, 2> {
 public:
  explicit FloorCost(const FloorFactor& f) : offset_M_(f.offset_M), root_(square_root<2>(f.information)) {}
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    Map<Eigen::Vector2d>{e} =
        root_ * floor_residual(Map<const Eigen::Vector2d>(x[0]), Map<const Eigen::Vector2d>(x[1]), offset_M_);
    if (J != nullptr && J[0] != nullptr) write<2, 2>(J[0], root_);
    if (J != nullptr && J[1] != nullptr) write<2, 2>(J[1], -root_);
    return true;
  }

 private:
  Eigen::Vector2d offset_M_;
  Eigen::Matrix2d root_;
};

class DuplicateCost : public ceres::SizedCostFunction<4, 4, 4> {
 public:
  explicit DuplicateCost(const DuplicateFactor& f) : anchor_M_(f.anchor_M) {
    const double angle = 1.0 / f.angle_sigma;
    root_ = Eigen::Vector4d(angle, angle, angle, 1.0 / f.offset_sigma).asDiagonal();
  }
  bool Evaluate(double const* const* x, double* e, double** J) const override {
    const DuplicateResidual r = duplicate_residual(to_plane(x[0]), to_plane(x[1]), anchor_M_);
    Map<Eigen::Vector4d>{e} = root_ * r.e;
    if (J != nullptr && J[0] != nullptr) write<4, 4>(J[0], root_ * r.J_a);
    if (J != nullptr && J[1] != nullptr) write<4, 4>(J[1], root_ * r.J_b);
    return true;
  }

 private:
  Eigen::Vector3d anchor_M_;
  Eigen::Matrix4d root_;
};

}  // namespace

PoseBlock to_block(const Pose& X) { return {X.q.x(), X.q.y(), X.q.z(), X.q.w(), X.t.x(), X.t.y(), X.t.z()}; }

PlaneBlock to_block(const Plane& plane) { return {plane.n.x(), plane.n.y(), plane.n.z(), plane.d}; }

Pose to_pose(const double* b) { return {Eigen::Quaterniond(b[3], b[0], b[1], b[2]), {b[4], b[5], b[6]}}; }

Plane to_plane(const double* b) { return {{b[0], b[1], b[2]}, b[3]}; }

bool TangentManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(jacobian, ambient_, tangent_)
      .setIdentity();
  return true;
}

bool TangentManifold::Minus(const double* /*y*/, const double* /*x*/, double* /*y_minus_x*/) const { return false; }

bool TangentManifold::MinusJacobian(const double* /*x*/, double* /*jacobian*/) const { return false; }

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const PoseBlock moved = to_block(increment(to_pose(x), Map<const Vector6d>(delta)));
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool PlaneManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const PlaneBlock moved = to_block(increment(to_plane(x), Map<const Eigen::Vector3d>(delta)));
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

ceres::CostFunction* pose_cost(const PoseFactor& factor) { return new PoseCost(factor); }
ceres::CostFunction* plane_cost(const PlaneFactor& factor) { return new PlaneCost(factor); }
ceres::CostFunction* room_cost(const RoomFactor& factor) {
  if (!factor.corners.empty()) return new PolygonCost(factor);
  if (factor.planes.size() == 4) return new FourWallCost(factor);
  if (factor.planes.size() == 2) return new TwoWallCost(factor);
  throw InternalError("room factor needs two or four planes");
}
ceres::CostFunction* floor_cost(const FloorFactor& factor) { return new FloorCost(factor); }
ceres::CostFunction* duplicate_cost(const DuplicateFactor& factor) { return new DuplicateCost(factor); }

}  // namespace plumbline::slam
