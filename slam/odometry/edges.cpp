// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/edges.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <optional>
#include <utility>

#include "slam/odometry/voxel.h"

namespace plumbline::slam {

namespace {

std::optional<loam::Match> to_line(const Eigen::Vector3d& p_R, const loam::PointMap::Neighbours& points,
                                   const EdgeConfig& config) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(scatter);
  if (!(eigen.eigenvalues()(2) > config.line_ratio * eigen.eigenvalues()(1))) return std::nullopt;
  const Eigen::Vector3d along = eigen.eigenvectors().col(2);
  if (std::abs(along.z()) < config.upright) return std::nullopt;
  return loam::Match{p_R, mean, Eigen::Matrix3d::Identity() - along * along.transpose()};
}

}  // namespace

std::vector<Eigen::Vector3d> edge_points(const DeskewedScan& scan, const EdgeConfig& config) {
  std::vector<Eigen::Vector3d> points;
  if (!config.enabled) return points;
  VoxelIndex seen;
  for (const loam::FeaturePoint& f : loam::find_edges(scan, config.features)) {
    const int before = seen.size();
    if (seen.insert(VoxelKey::of(f.p_R, config.leaf_m)) == before) points.push_back(f.p_R);
  }
  return points;
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
  for (const Eigen::Vector3d& p_R : points_R)
    if (points_.nearest(X_MR * p_R, config_.reach_m * config_.reach_m, near))
      if (const std::optional<loam::Match> match = to_line(p_R, near, config_)) matches.push_back(*match);
  return matches;
}

}  // namespace plumbline::slam
