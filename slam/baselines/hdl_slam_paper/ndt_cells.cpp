// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/ndt_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bim/geometry/symmetric.h"

namespace plumbline::slam::hdl {

namespace {

constexpr double least_eigenvalue_share = 0.01;

}  // namespace

NdtConstants ndt_constants(double cell_m, double outlier_share) {
  const double c1 = 10.0 * (1.0 - outlier_share), c2 = outlier_share / (cell_m * cell_m * cell_m);
  const double d3 = -std::log(c2);
  const double d1 = -std::log(c1 + c2) - d3;
  return {d1, -2.0 * std::log((-std::log(c1 * std::exp(-0.5) + c2) - d3) / d1)};
}

Pose retract(const Pose& X_TS, const Vector6d& step) {
  const Eigen::Vector3d translation = step.head<3>(), rotation = step.tail<3>();
  return {(X_TS.q * exp_so3(rotation)).normalized(), X_TS.t + X_TS.q * translation};
}

void NdtCells::set(const std::vector<Eigen::Vector3d>& points_T) {
  index_.clear();
  cells_.clear();
  for (const Eigen::Vector3d& p : points_T) {
    const auto slot = static_cast<std::size_t>(index_.insert(VoxelKey::of(p, config_.cell_m)));
    if (slot >= cells_.size()) cells_.resize(slot + 1);
    Cell& cell = cells_[slot];
    cell.n += 1.0;
    cell.sum += p;
    cell.squares += p * p.transpose();
  }
  for (Cell& cell : cells_) complete(cell);
}

void NdtCells::complete(Cell& cell) const {
  if (cell.n < config_.least_points) return;
  cell.mean = cell.sum / cell.n;
  const Eigen::Matrix3d covariance =
      (cell.squares - cell.n * cell.mean * cell.mean.transpose()) / std::max(1.0, cell.n - 1.0);
  const SymmetricEigen<3> eigen = symmetric_eigen(covariance);
  Eigen::Vector3d values = eigen.values;
  if (!(values[2] > 1e-12)) return;
  values = values.cwiseMax(least_eigenvalue_share * values[2]);
  cell.information = eigen.vectors * values.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
  cell.valid = true;
}

NdtScore NdtCells::score(const std::vector<Eigen::Vector3d>& points_S, const Pose& X_TS) const {
  static constexpr std::array<std::array<int, 3>, 7> around = {
      {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  NdtScore score;
  const Eigen::Matrix3d R = X_TS.rotation();
  for (const Eigen::Vector3d& p_S : points_S) {
    const Eigen::Vector3d p_T = R * p_S + X_TS.t;
    if (!(p_T.lpNorm<Eigen::Infinity>() < 1e4)) continue;  // a step too far; the grid ends
    const VoxelKey key = VoxelKey::of(p_T, config_.cell_m);
    Eigen::Matrix<double, 3, 6> J;
    bool has_J = false;
    for (const auto& [x, y, z] : around) {
      const int slot = index_.find({key.x + x, key.y + y, key.z + z});
      if (slot < 0 || !cells_[static_cast<std::size_t>(slot)].valid) continue;
      const Cell& cell = cells_[static_cast<std::size_t>(slot)];
      const Eigen::Vector3d e = p_T - cell.mean;
      const Eigen::Vector3d Be = cell.information * e;
      const double value = constants_.d1 * std::exp(-0.5 * constants_.d2 * e.dot(Be));
      const double weight = -constants_.d2 * value;
      score.value += value;
      if (weight < 1e-9) continue;
      if (!has_J) {
        J << R, -R * hat(p_S);
        has_J = true;
      }
      const Vector6d g = J.transpose() * Be;
      score.gradient += weight * g;
      score.hessian += weight * (J.transpose() * cell.information * J - constants_.d2 * g * g.transpose());
      // The turned point curves [magnusson2009, eq. 6.21].
      const Eigen::Vector3d Be_S = R.transpose() * Be;
      const Eigen::Matrix3d outer = 0.5 * (Be_S * p_S.transpose() + p_S * Be_S.transpose());
      score.hessian.bottomRightCorner<3, 3>() += weight * (outer - Be_S.dot(p_S) * Eigen::Matrix3d::Identity());
    }
  }
  return score;
}

}  // namespace plumbline::slam::hdl
