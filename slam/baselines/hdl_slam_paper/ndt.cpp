// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "bim/geometry/symmetric.h"
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::hdl {

namespace {

constexpr double least_eigenvalue_share = 0.01;

struct Cell {
  double n = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero(), information = Eigen::Matrix3d::Zero();
  bool valid = false;
};

/// Information of a cell's points; thin directions are widened to a hundredth of the widest.
void complete(Cell& cell, int least_points) {
  if (cell.n < least_points) return;
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

/// Score with its gradient and the Hessian of the Gaussians' quadratic forms alone; lower is better.
struct Score {
  double value = 0.0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d hessian = Matrix6d::Zero();
};

class Ndt final : public CloudMatcher {
 public:
  explicit Ndt(const NdtConfig& config)
      : config_(config), constants_(ndt_constants(config.cell_m, config.outlier_share)) {}

  void set_target(const std::vector<Eigen::Vector3d>& points_T) override {
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
    for (Cell& cell : cells_) complete(cell, config_.least_points);
  }

  // Levenberg-Marquardt instead of the reference's line search.
  [[nodiscard]] CloudMatch match(const std::vector<Eigen::Vector3d>& points_S, const Pose& guess) const override {
    CloudMatch match{guess, false};
    Score score = score_at(points_S, match.X_TS);
    if (!(score.value < 0.0)) return match;
    match.converged = true;
    double lambda = 1e-6;
    for (int i = 0; i < config_.max_iterations; ++i) {
      Matrix6d damped = score.hessian;
      damped.diagonal() += lambda * score.hessian.diagonal() + Vector6d::Constant(1e-9);
      const Vector6d step = -solve_ldlt(damped, score.gradient);
      if (!step.allFinite()) break;
      Pose moved = match.X_TS * exp_se3(step);
      moved.q.normalize();
      const Score next = score_at(points_S, moved);
      const bool better = next.value < score.value;
      if (better) {
        match.X_TS = moved;
        score = next;
      }
      lambda = better ? std::max(1e-9, 0.1 * lambda) : 10.0 * lambda;
      if ((better && step.norm() < config_.epsilon) || lambda > 1e6) break;
    }
    return match;
  }

 private:
  [[nodiscard]] Score score_at(const std::vector<Eigen::Vector3d>& points_S, const Pose& X_TS) const {
    static constexpr std::array<std::array<int, 3>, 7> around = {
        {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
    Score score;
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
        score.gradient += weight * (J.transpose() * Be);
        score.hessian += weight * (J.transpose() * cell.information * J);
      }
    }
    return score;
  }

  NdtConfig config_;
  NdtConstants constants_;
  VoxelIndex index_;
  std::vector<Cell> cells_;
};

}  // namespace

NdtConstants ndt_constants(double cell_m, double outlier_share) {
  const double c1 = 10.0 * (1.0 - outlier_share), c2 = outlier_share / (cell_m * cell_m * cell_m);
  const double d3 = -std::log(c2);
  const double d1 = -std::log(c1 + c2) - d3;
  return {d1, -2.0 * std::log((-std::log(c1 * std::exp(-0.5) + c2) - d3) / d1)};
}

std::unique_ptr<CloudMatcher> make_ndt(const NdtConfig& config) { return std::make_unique<Ndt>(config); }

}  // namespace plumbline::slam::hdl
