// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/trot/force_distribution.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace plumbline::sim {

namespace {

constexpr int rows_per_leg = 5;

/// Importance of fx, fy, fz and of the torques about x, y, z.
Vector6d wrench_weights() {
  Vector6d s;
  s << 1.0, 1.0, 2.0, 20.0, 20.0, 5.0;
  return s;
}

/// Constraint values of one leg's force.
Eigen::Matrix<double, rows_per_leg, 3> leg_constraints(double mu) {
  Eigen::Matrix<double, rows_per_leg, 3> G;
  G << 1.0, 0.0, mu,  //
      -1.0, 0.0, mu,  //
      0.0, 1.0, mu,   //
      0.0, -1.0, mu,  //
      0.0, 0.0, 1.0;
  return G;
}

Eigen::Matrix<double, 6, 12> wrench_of_forces(const PerLeg<Eigen::Vector3d>& lever_W) {
  Eigen::Matrix<double, 6, 12> A;
  for (std::size_t i = 0; i < leg_count; ++i) {
    const int col = 3 * static_cast<int>(i);
    A.block<3, 3>(0, col).setIdentity();
    A.block<3, 3>(3, col) = hat(lever_W[i]);
  }
  return A;
}

}  // namespace

void ForceDistribution::forget(std::size_t leg) {
  const int i = static_cast<int>(leg);
  previous_.segment<3>(3 * i).setZero();
  z_.segment<rows_per_leg>(rows_per_leg * i).setZero();
  u_.segment<rows_per_leg>(rows_per_leg * i).setZero();
}

ForceDistribution::Force ForceDistribution::iterate(const Eigen::Matrix<double, forces, forces>& H, const Force& g,
                                                    const PerLeg<double>& fz_max) {
  const Eigen::Matrix<double, rows_per_leg, 3> G = leg_constraints(config_.friction);
  const Eigen::Matrix3d GtG = G.transpose() * G;
  Eigen::Matrix<double, forces, forces> K = H;
  for (int leg = 0; leg < 4; ++leg) K.block<3, 3>(3 * leg, 3 * leg) += config_.rho * GtG;
  // One inverse for many products: at this size cheaper than as many solves.
  using Matrix = Eigen::Matrix<double, forces, forces>;
  const Matrix K_inverse = K.ldlt().solve(Matrix::Identity());

  Force f = previous_;
  for (int k = 0; k < config_.iterations; ++k) {
    Force rhs = -g;
    for (int leg = 0; leg < 4; ++leg)
      rhs.segment<3>(3 * leg) += config_.rho * (G.transpose() * (z_ - u_).segment<rows_per_leg>(rows_per_leg * leg));
    f.noalias() = K_inverse * rhs;
    for (int leg = 0; leg < 4; ++leg) {
      const double top = fz_max[static_cast<std::size_t>(leg)];
      const int row = rows_per_leg * leg;
      const Eigen::Matrix<double, rows_per_leg, 1> value = G * f.segment<3>(3 * leg);
      const Eigen::Matrix<double, rows_per_leg, 1> shifted = value + u_.segment<rows_per_leg>(row);
      z_.segment<rows_per_leg>(row) = shifted.cwiseMax(0.0);
      z_[row + 4] = std::clamp(shifted[4], std::min(config_.fz_min_n, top), top);
      u_.segment<rows_per_leg>(row) = shifted - z_.segment<rows_per_leg>(row);
    }
  }
  return f;
}

PerLeg<Eigen::Vector3d> ForceDistribution::solve(const Wrench& wrench, const PerLeg<Eigen::Vector3d>& lever_W,
                                                 const PerLeg<double>& fz_max) {
  for (std::size_t leg = 0; leg < leg_count; ++leg)
    if (fz_max[leg] <= 0.0) forget(leg);

  const Eigen::Matrix<double, 6, forces> A = wrench_of_forces(lever_W);
  const Eigen::Matrix<double, forces, 6> AtS = A.transpose() * wrench_weights().asDiagonal();
  Eigen::Matrix<double, forces, forces> H = AtS * A;
  H.diagonal().array() += config_.alpha + config_.beta;
  Force g = -(AtS * wrench) - config_.beta * previous_;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    if (fz_max[leg] > 0.0) continue;
    const int i = 3 * static_cast<int>(leg);
    H.middleRows<3>(i).setZero();
    H.middleCols<3>(i).setZero();
    H.block<3, 3>(i, i).setIdentity();
    g.segment<3>(i).setZero();
  }
  const Force f = iterate(H, g, fz_max);

  PerLeg<Eigen::Vector3d> out;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector3d raw = f.segment<3>(3 * static_cast<int>(leg));
    const double fz = std::clamp(raw.z(), 0.0, fz_max[leg]);
    const double limit = config_.friction * fz;
    out[leg] = {std::clamp(raw.x(), -limit, limit), std::clamp(raw.y(), -limit, limit), fz};
    previous_.segment<3>(3 * static_cast<int>(leg)) = out[leg];
  }
  return out;
}

}  // namespace plumbline::sim
