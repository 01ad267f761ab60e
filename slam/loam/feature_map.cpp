// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/feature_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "slam/registration/match.h"

namespace plumbline::slam::loam {

ThinFeatures thin(const Features& features, const MapConfig& config) {
  return {first_of_each_leaf(features.less_sharp, config.edge_leaf_m),
          first_of_each_leaf(features.less_flat, config.plane_leaf_m)};
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
          if (const std::optional<Match> match = match_one(p_R)) matches.push_back(*match);
    };
    add(edges_, features.edges_R,
        [&](const Eigen::Vector3d& p_R) { return line_match(p_R, near, config_.line_ratio); });
    add(planes_, features.planes_R, [&](const Eigen::Vector3d& p_R) {
      return plane_match(p_R, near, config_.plane_ratio, config_.plane_tolerance_m);
    });
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
