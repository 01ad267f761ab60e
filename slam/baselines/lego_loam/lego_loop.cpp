// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/lego_loop.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "slam/scan/voxel.h"

namespace plumbline::slam::lego {

IcpResult icp(const std::vector<Eigen::Vector3d>& points_T, const std::vector<Eigen::Vector3d>& points_S,
              const Pose& guess, const LoopConfig& config) {
  constexpr double still_m = 1e-4, still_rad = 1e-4;
  const KdTree target(points_T);
  IcpResult result{guess};
  const double reach2 = config.reach_m * config.reach_m;
  for (int i = 0; i < config.iterations; ++i) {
    Eigen::Matrix3Xd from(3, points_S.size()), to(3, points_S.size());
    Eigen::Index n = 0;
    for (const Eigen::Vector3d& p_S : points_S) {
      const Eigen::Vector3d p_T = result.X_TS * p_S;
      const auto near = target.nearest(p_T, 1);
      if (near.front().distance2 > reach2) continue;
      from.col(n) = p_T;
      to.col(n++) = points_T[near.front().index];
    }
    if (n < 6) break;
    const Eigen::Matrix4d moved = Eigen::umeyama(from.leftCols(n), to.leftCols(n), false);
    const Eigen::Matrix3d R = moved.topLeftCorner<3, 3>();
    const Pose step{Eigen::Quaterniond(R).normalized(), moved.topRightCorner<3, 1>()};
    const Eigen::Vector3d before = result.X_TS.t;
    result.X_TS = step * result.X_TS;
    result.X_TS.q.normalize();
    if ((result.X_TS.t - before).norm() < still_m && log_so3(step.q).norm() < still_rad) break;
  }
  for (const Eigen::Vector3d& p_S : points_S)
    result.fitness_m2 += target.nearest(result.X_TS * p_S, 1).front().distance2;
  result.fitness_m2 /= static_cast<double>(points_S.size());
  return result;
}

std::optional<Loop> find_loop(const loam::KeyframeMap& map, const std::vector<Nanoseconds>& stamps,
                              const LoopConfig& config) {
  const std::size_t now = map.size() - 1;
  std::optional<std::size_t> old;
  double nearest_m = config.radius_m;
  for (std::size_t k = 0; k < now; ++k) {
    const double distance_m = (map.pose(k).t - map.pose(now).t).norm();
    if (seconds(stamps[now] - stamps[k]) <= config.least_s || distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    old = k;
  }
  if (!old) return std::nullopt;
  const auto reach = static_cast<std::size_t>(config.neighbours);
  VoxelMeans target(config.leaf_m);
  const Pose X_FM = map.pose(*old).inverse();
  // The newest keyframe's own neighbours would hold it where it is.
  for (std::size_t k = *old - std::min(*old, reach); k <= std::min(*old + reach, now - 1); ++k) {
    if (seconds(stamps[now] - stamps[k]) <= 0.5 * config.least_s) break;
    const Pose X_FR = X_FM * map.pose(k);
    for (const auto* points : {&map.features(k).edges_R, &map.features(k).flats_R})
      for (const Eigen::Vector3d& p_R : *points) target.add(X_FR * p_R);
  }
  std::vector<Eigen::Vector3d> source = map.features(now).edges_R;
  source.insert(source.end(), map.features(now).flats_R.begin(), map.features(now).flats_R.end());
  const std::vector<Eigen::Vector3d> points_F = target.means();
  if (points_F.size() < 6 || source.size() < 6) return std::nullopt;
  const IcpResult found = icp(points_F, source, X_FM * map.pose(now), config);
  if (found.fitness_m2 > config.fitness_m2) return std::nullopt;
  return Loop{*old, found.X_TS, found.fitness_m2};
}

}  // namespace plumbline::slam::lego
