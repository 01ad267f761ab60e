// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/upright_edges.h"

#include <optional>
#include <utility>

namespace plumbline::slam {

std::vector<Eigen::Vector3d> edge_points(const DeskewedScan& scan, const EdgeConfig& config) {
  if (!config.enabled) return {};
  return loam::first_of_each_leaf(loam::find_edges(scan, config.features), config.leaf_m);
}

void EdgeMap::add(std::vector<Eigen::Vector3d> points_R, const Pose& X_MR, std::size_t keep) {
  for (Eigen::Vector3d& p : points_R) p = X_MR * p;
  keyframes_.push_back(std::move(points_R));
  if (keyframes_.size() <= keep) {
    for (const Eigen::Vector3d& p_M : keyframes_.back()) points_.add(p_M);
    return;
  }
  keyframes_.pop_front();
  points_ = loam::PointMap(config_.leaf_m, config_.reach_m);
  for (const std::vector<Eigen::Vector3d>& keyframe : keyframes_)
    for (const Eigen::Vector3d& p_M : keyframe) points_.add(p_M);
}

std::vector<loam::Match> EdgeMap::match(std::span<const Eigen::Vector3d> points_R, const Pose& X_MR) const {
  std::vector<loam::Match> matches;
  loam::PointMap::Neighbours near;
  const double most_level = 1.0 - config_.upright * config_.upright;  // of I - d d^T: its last entry is 1 - d_z^2
  for (const Eigen::Vector3d& p_R : points_R) {
    if (!points_.nearest(X_MR * p_R, config_.reach_m * config_.reach_m, near)) continue;
    const std::optional<loam::Match> match = loam::line_match(p_R, near, config_.line_ratio);
    if (match && match->across(2, 2) <= most_level) matches.push_back(*match);
  }
  return matches;
}

}  // namespace plumbline::slam
