// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/floor_detection.h"

#include <cmath>

#include "bim/geometry/symmetric.h"
#include "slam/planes/sac_segmentation.h"
#include "slam/scan/kd_tree.h"

namespace plumbline::slam::hdl {

namespace {

/// Points whose neighbours lie level.
std::vector<Eigen::Vector3d> upright(const std::vector<Eigen::Vector3d>& points, const FloorDetectionConfig& config) {
  const KdTree tree(points);
  const double cos_limit = std::cos(config.normal_rad);
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& p : points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double n = 0.0;
    for (const Neighbour& near : tree.nearest(p, static_cast<std::size_t>(config.neighbours))) {
      const Eigen::Vector3d d = points[near.index] - p;
      mean += d;
      squares += d * d.transpose();
      n += 1.0;
    }
    mean /= n;
    const Eigen::Matrix3d scatter = squares / n - mean * mean.transpose();
    if (std::abs(symmetric_eigen(scatter).vectors(2, 0)) > cos_limit) kept.push_back(p);
  }
  return kept;
}

}  // namespace

std::optional<Plane> detect_floor(const std::vector<Eigen::Vector3d>& points_R, double height_m,
                                  const FloorDetectionConfig& config) {
  std::vector<Eigen::Vector3d> near;
  for (const Eigen::Vector3d& p : points_R)
    if (std::abs(p.z() + height_m) <= config.clip_m) near.push_back(p);
  const auto enough = [&](std::size_t n) { return n >= static_cast<std::size_t>(config.least_points); };
  if (!enough(near.size())) return std::nullopt;
  near = upright(near, config);
  if (!enough(near.size())) return std::nullopt;
  const std::optional<SacPlane> found = sac_plane(near, config.distance_m, config.iterations, 0.99);
  if (!found || !enough(found->inliers.size())) return std::nullopt;
  Plane floor = found->plane;
  if (floor.n.z() < 0.0) floor = {-floor.n, -floor.d};
  if (floor.n.z() < std::cos(config.tilt_rad)) return std::nullopt;
  return floor;
}

}  // namespace plumbline::slam::hdl
