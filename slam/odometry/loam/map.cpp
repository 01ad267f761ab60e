// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/loam/map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/odometry/loam/match.h"

namespace plumbline::slam::loam {

namespace {

Eigen::Vector3d mean_of(const PointMap::Neighbours& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter_of(const PointMap::Neighbours& points,
                                                          const Eigen::Vector3d& mean) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  return eigen;
}

std::optional<Match> match_edge(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points,
                                const MapConfig& config) {
  const Eigen::Vector3d mean = mean_of(points);
  const auto eigen = scatter_of(points, mean);
  if (!(eigen.eigenvalues()(2) > config.line_ratio * eigen.eigenvalues()(1))) return std::nullopt;
  const Eigen::Vector3d along = eigen.eigenvectors().col(2);
  return Match{p_R, mean, Eigen::Matrix3d::Identity() - along * along.transpose()};
}

std::optional<Match> match_map_plane(const Eigen::Vector3d& p_R, const PointMap::Neighbours& points,
                                     const MapConfig& config) {
  const Eigen::Vector3d mean = mean_of(points);
  const auto eigen = scatter_of(points, mean);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  for (const Eigen::Vector3d& p : points)
    if (!(std::abs(normal.dot(p - mean)) <= config.plane_tolerance_m)) return std::nullopt;
  if (!(eigen.eigenvalues()(1) > config.plane_ratio * eigen.eigenvalues()(0))) return std::nullopt;
  return Match{p_R, mean, normal * normal.transpose()};
}

}  // namespace

ThinFeatures thin(const Features& features, const MapConfig& config) {
  const auto points = [](const std::vector<FeaturePoint>& from, double leaf_m) {
    std::vector<Eigen::Vector3d> out;
    out.reserve(from.size());
    VoxelIndex seen;
    for (const FeaturePoint& f : from) {
      const int before = seen.size();
      if (seen.insert(VoxelKey::of(f.p_R, leaf_m)) == before) out.push_back(f.p_R);
    }
    return out;
  };
  return {points(features.less_sharp, config.edge_leaf_m), points(features.less_flat, config.plane_leaf_m)};
}

FeatureMap::FeatureMap(const MapConfig& config)
    : config_(config), edges_(config.edge_leaf_m), planes_(config.plane_leaf_m) {}

void FeatureMap::add(const ThinFeatures& features, const Pose& X_MR) {
  for (const Eigen::Vector3d& p_R : features.edges_R) edges_.add(X_MR * p_R);
  for (const Eigen::Vector3d& p_R : features.planes_R) planes_.add(X_MR * p_R);
}

Registration FeatureMap::align(const ThinFeatures& features, const Pose& start, int rounds) const {
  Registration result;
  result.X_MR = start;
  Normal6 normal;
  std::vector<Match> matches;
  for (int round = 0; round < rounds; ++round) {
    matches.clear();
    PointMap::Neighbours near;
    const auto add = [&](const PointMap& map, const std::vector<Eigen::Vector3d>& points_R, auto&& match_one) {
      for (const Eigen::Vector3d& p_R : points_R)
        if (map.nearest(result.X_MR * p_R, config_.max_distance2_m2, near))
          if (const std::optional<Match> match = match_one(p_R, near, config_)) matches.push_back(*match);
    };
    add(edges_, features.edges_R, match_edge);
    add(planes_, features.planes_R, match_map_plane);
    for (int i = 0; i < config_.iterations; ++i) {
      ++result.iterations;
      normal = linearize(matches, result.X_MR, config_.huber_m);
      const std::optional<Vector6d> step = solve_step(normal);
      if (!step) return result;
      result.X_MR = result.X_MR * exp_se3(*step);
      result.converged = step->norm() < 1e-4;
      if (result.converged) break;
    }
  }
  const double variance = std::max(normal.squared / std::max(normal.inliers, 1.0), 1e-6);
  result.information = normal.h / variance;
  const auto features_in = static_cast<double>(features.edges_R.size() + features.planes_R.size());
  if (features_in > 0.0) result.matched = normal.inliers / features_in;
  result.rms = std::sqrt(variance);
  return result;
}

}  // namespace plumbline::slam::loam
