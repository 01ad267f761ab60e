// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/mloam/window.h"

#include <algorithm>
#include <utility>

#include "bim/geometry/symmetric.h"
#include "slam/loam/degeneracy.h"
#include "slam/registration/match.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam::mloam {

namespace {

constexpr std::size_t least_matches = 20;

/// The map of the scans up to the pivot, in its frame P.
struct LocalMap {
  KdTree edges, flats;
};

std::optional<loam::PointMap::Neighbours> five_nearest(const KdTree& map, const Eigen::Vector3d& p,
                                                       double max_distance2) {
  loam::PointMap::Neighbours found;
  const auto near = map.nearest(p, found.size());
  if (near.size() < found.size() || !(near.back().distance2 < max_distance2)) return std::nullopt;
  for (std::size_t k = 0; k < found.size(); ++k) found[k] = map.points()[near[k].index];
  return found;
}

std::vector<loam::Match> matches_of(const loam::MapFeatures& features, const LocalMap& map, const Pose& X_PR,
                                    const WindowConfig& config) {
  std::vector<loam::Match> matches;
  for (const Eigen::Vector3d& p_R : features.edges_R)
    if (const auto near = five_nearest(map.edges, X_PR * p_R, config.max_distance2_m2))
      if (const auto match = loam::line_match(p_R, *near, config.line_ratio)) matches.push_back(*match);
  for (const Eigen::Vector3d& p_R : features.flats_R)
    if (const auto near = five_nearest(map.flats, X_PR * p_R, config.max_distance2_m2))
      if (const auto match = loam::plane_match(p_R, *near, config.plane_ratio, config.plane_tolerance_m))
        matches.push_back(*match);
  return matches;
}

/// d(X_P^-1 X_k) by a right increment of X_P, as a right increment of the product: minus its inverse adjoint.
Matrix6d by_pivot(const Pose& X_Pk) { return -adjoint(X_Pk.inverse()); }

}  // namespace

Quadratic marginalized(const Quadratic& quadratic, Eigen::Index n) {
  const Eigen::Index rest = quadratic.g.size() - n;
  const auto eigen = symmetric_eigen(Eigen::MatrixXd(quadratic.H.topLeftCorner(n, n)));
  const double least = 1e-12 * std::max(1.0, eigen.values.cwiseAbs().maxCoeff());
  const Eigen::VectorXd inverse =
      eigen.values.unaryExpr([&](double value) { return value > least ? 1.0 / value : 0.0; });
  const Eigen::MatrixXd A = eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
  const Eigen::MatrixXd B = quadratic.H.bottomLeftCorner(rest, n);
  return {quadratic.H.bottomRightCorner(rest, rest) - B * A * B.transpose(),
          quadratic.g.tail(rest) - B * A * quadratic.g.head(n)};
}

void Window::clear() {
  scans_.clear();
  prior_.reset();
  prior_poses_.clear();
}

std::size_t Window::pivot() const {
  const auto optimized = std::min<std::size_t>(static_cast<std::size_t>(config_.optimized), scans_.size() - 1);
  return scans_.size() - 1 - optimized;
}

std::optional<Pose> Window::add(const loam::MapFeatures& features, const Pose& X_MR) {
  if (scans_.size() == static_cast<std::size_t>(config_.scans)) slide();
  scans_.push_back({features, X_MR});
  if (scans_.size() == 1 || !optimize()) return std::nullopt;
  return scans_.back().X_MR;
}

// The pivot moves on by one: what its residuals say of the later poses becomes the prior.
void Window::slide() {
  const std::size_t p = pivot();
  prior_ = marginalized(last_, 6);
  prior_poses_.clear();
  for (std::size_t k = p + 1; k < scans_.size(); ++k) prior_poses_.push_back(scans_[k].X_MR);
  scans_.pop_front();
}

bool Window::optimize() {
  const std::size_t p = pivot(), n = scans_.size() - p;
  const auto size = static_cast<Eigen::Index>(6 * n);
  const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(6 * k); };
  VoxelMeans edges(config_.edge_leaf_m), flats(config_.flat_leaf_m);
  for (std::size_t k = 0; k <= p; ++k) {
    const Pose X_PR = scans_[p].X_MR.inverse() * scans_[k].X_MR;
    for (const Eigen::Vector3d& p_R : scans_[k].features.edges_R) edges.add(X_PR * p_R);
    for (const Eigen::Vector3d& p_R : scans_[k].features.flats_R) flats.add(X_PR * p_R);
  }
  const LocalMap map{KdTree(edges.means()), KdTree(flats.means())};
  std::vector<std::vector<loam::Match>> matches(n);
  for (std::size_t k = 1; k < n; ++k)
    matches[k] = matches_of(scans_[p + k].features, map, scans_[p].X_MR.inverse() * scans_[p + k].X_MR, config_);
  for (int iteration = 0; iteration < config_.iterations; ++iteration) {
    Quadratic sum{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
    std::vector<Eigen::MatrixXd> good(n, Eigen::MatrixXd::Identity(6, 6));
    for (std::size_t k = 1; k < n; ++k) {
      const Pose X_PR = scans_[p].X_MR.inverse() * scans_[p + k].X_MR;
      const Normal6 normal = loam::linearize(matches[k], X_PR, config_.huber_m);
      good[k] = loam::good_directions(normal.h, config_.least_eigenvalue).projection;
      const Matrix6d J = by_pivot(X_PR);
      sum.H.block<6, 6>(at(k), at(k)) += normal.h;
      sum.H.block<6, 6>(0, 0) += J.transpose() * normal.h * J;
      sum.H.block<6, 6>(0, at(k)) += J.transpose() * normal.h;
      sum.H.block<6, 6>(at(k), 0) += normal.h * J;
      sum.g.segment<6>(at(k)) += normal.g;
      sum.g.head<6>() += J.transpose() * normal.g;
    }
    if (prior_ && prior_poses_.size() + 1 == n) {
      Eigen::VectorXd moved(prior_->g.size());
      for (std::size_t k = 0; k < prior_poses_.size(); ++k)
        moved.segment<6>(at(k)) = log_se3(prior_poses_[k].inverse() * scans_[p + k].X_MR);
      const Eigen::Index old = prior_->g.size();
      sum.H.topLeftCorner(old, old) += prior_->H;
      sum.g.head(old) += prior_->g + prior_->H * moved;
    }
    last_ = std::move(sum);
    const Eigen::Index free = size - 6;
    const Eigen::MatrixXd H = last_.H.bottomRightCorner(free, free) + 1e-6 * Eigen::MatrixXd::Identity(free, free);
    const Eigen::VectorXd step = -solve_ldlt(H, Eigen::VectorXd(last_.g.tail(free)));
    if (!step.allFinite()) return false;
    for (std::size_t k = 1; k < n; ++k) {
      const Vector6d kept = good[k] * step.segment<6>(at(k - 1));
      scans_[p + k].X_MR = scans_[p + k].X_MR * exp_se3(kept);
      last_.g += last_.H.middleCols<6>(at(k)) * kept;  // it is about the new poses
      scans_[p + k].X_MR.q.normalize();
    }
    if (step.norm() < 1e-5) break;
  }
  return matches.back().size() >= least_matches;
}

}  // namespace plumbline::slam::mloam
