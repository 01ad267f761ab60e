// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bim/geometry/symmetric.h"
#include "slam/baselines/hdl_slam_paper/cloud_matcher.h"
#include "slam/scan/kd_tree.h"

namespace plumbline::slam::hdl {

namespace {

constexpr double thin = 1e-3;
constexpr int most_tries = 10;

/// Spreads of each point's neighbours, made discs: eigenvalues 1, 1 and a thousandth.
std::vector<Eigen::Matrix3d> discs(const KdTree& tree, int neighbours) {
  std::vector<Eigen::Matrix3d> covariances;
  covariances.reserve(tree.points().size());
  for (const Eigen::Vector3d& p : tree.points()) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double n = 0.0;
    for (const Neighbour& near : tree.nearest(p, static_cast<std::size_t>(neighbours))) {
      const Eigen::Vector3d d = tree.points()[near.index] - p;
      mean += d;
      squares += d * d.transpose();
      n += 1.0;
    }
    mean /= n;
    const Eigen::Matrix3d scatter = squares / n - mean * mean.transpose();
    const Eigen::Matrix3d V = symmetric_eigen(scatter).vectors;
    covariances.push_back(V * Eigen::Vector3d(thin, 1.0, 1.0).asDiagonal() * V.transpose());
  }
  return covariances;
}

struct Pairing {
  std::size_t source = 0, target = 0;
  Eigen::Matrix3d information;
};

class Gicp final : public CloudMatcher {
 public:
  explicit Gicp(const GicpConfig& config) : config_(config) {}

  void set_target(const std::vector<Eigen::Vector3d>& points_T) override {
    target_.emplace(points_T);
    target_discs_ = discs(*target_, config_.neighbours);
  }

  [[nodiscard]] CloudMatch match(const std::vector<Eigen::Vector3d>& points_S, const Pose& guess) const override {
    CloudMatch match{guess, false};
    if (!target_ || target_->points().empty() || points_S.empty()) return match;
    const std::vector<Eigen::Matrix3d> source_discs = discs(KdTree(points_S), config_.neighbours);
    double lambda = -1.0;
    for (int i = 0; i < config_.max_iterations; ++i) {
      const std::vector<Pairing> pairs = pair(points_S, source_discs, match.X_TS);
      if (pairs.empty()) return match;
      Matrix6d H = Matrix6d::Zero();
      Vector6d g = Vector6d::Zero();
      const double cost = linearize(points_S, pairs, match.X_TS, H, g);
      if (lambda < 0.0) lambda = 1e-9 * H.diagonal().maxCoeff();
      std::optional<Pose> step;
      for (int k = 0; k < most_tries && !step; ++k) {
        const Matrix6d damped = H + lambda * Matrix6d::Identity();
        const Pose tried = exp_se3(-solve_ldlt(damped, g));
        if (cost_of(points_S, pairs, match.X_TS * tried) < cost) {
          step = tried;
        } else if (is_small(tried)) {
          match.converged = true;
          return match;
        }
        if (!step) lambda = std::max(1e-9, 10.0 * lambda);
      }
      if (!step) break;
      lambda *= 0.1;
      match.X_TS = match.X_TS * *step;
      match.X_TS.q.normalize();
      match.converged = is_small(*step);
      if (match.converged) break;
    }
    return match;
  }

 private:
  [[nodiscard]] bool is_small(const Pose& step) const {
    return (step.rotation() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < config_.rotation_epsilon &&
           step.t.cwiseAbs().maxCoeff() < config_.epsilon_m;
  }

  [[nodiscard]] std::vector<Pairing> pair(const std::vector<Eigen::Vector3d>& points_S,
                                          const std::vector<Eigen::Matrix3d>& source_discs, const Pose& X_TS) const {
    const double reach2 = config_.max_distance_m * config_.max_distance_m;
    const Eigen::Matrix3d R = X_TS.rotation();
    std::vector<Pairing> pairs;
    for (std::size_t i = 0; i < points_S.size(); ++i) {
      const auto near = target_->nearest(R * points_S[i] + X_TS.t, 1);
      if (near.empty() || near.front().distance2 > reach2) continue;
      const std::size_t k = near.front().index;
      pairs.push_back({i, k, (target_discs_[k] + R * source_discs[i] * R.transpose()).inverse()});
    }
    return pairs;
  }

  [[nodiscard]] double linearize(const std::vector<Eigen::Vector3d>& points_S, const std::vector<Pairing>& pairs,
                                 const Pose& X_TS, Matrix6d& H, Vector6d& g) const {
    const Eigen::Matrix3d R = X_TS.rotation();
    double cost = 0.0;
    for (const Pairing& pair : pairs) {
      const Eigen::Vector3d& p_S = points_S[pair.source];
      const Eigen::Vector3d e = R * p_S + X_TS.t - target_->points()[pair.target];
      Eigen::Matrix<double, 3, 6> J;
      J << R, -R * hat(p_S);
      cost += e.dot(pair.information * e);
      H += J.transpose() * pair.information * J;
      g += J.transpose() * (pair.information * e);
    }
    return cost;
  }

  [[nodiscard]] double cost_of(const std::vector<Eigen::Vector3d>& points_S, const std::vector<Pairing>& pairs,
                               const Pose& X_TS) const {
    double cost = 0.0;
    for (const Pairing& pair : pairs) {
      const Eigen::Vector3d e = X_TS * points_S[pair.source] - target_->points()[pair.target];
      cost += e.dot(pair.information * e);
    }
    return cost;
  }

  GicpConfig config_;
  std::optional<KdTree> target_;
  std::vector<Eigen::Matrix3d> target_discs_;
};

}  // namespace

std::unique_ptr<CloudMatcher> make_gicp(const GicpConfig& config) { return std::make_unique<Gicp>(config); }

}  // namespace plumbline::slam::hdl
