// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/registration_timing.h"

#include "slam/baselines/pcl_registration/pcl_matcher.h"
#include "slam/io/stopwatch.h"
#include "slam/registration/cloud_surfels.h"
#include "slam/scan/voxel.h"

namespace plumbline::scenarios {

namespace {

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3f>& points) {
  constexpr double leaf_m = 0.25;
  slam::VoxelMeans means(leaf_m);
  for (const Eigen::Vector3f& p : points) means.add(p.cast<double>());
  return means.means();
}

}  // namespace

Registered register_ours(const std::vector<Eigen::Vector3f>& target_T, const std::vector<Eigen::Vector3f>& source_S) {
  const slam::Stopwatch watch;
  const slam::Registration result = slam::register_clouds(target_T, source_S, Pose{}, {});
  return {result.X_MR, watch.cpu_ms()};
}

Registered register_pcl(const std::vector<Eigen::Vector3f>& target_T, const std::vector<Eigen::Vector3f>& source_S) {
  constexpr double any_distance_m = 5.0;  // PCL's default
  const slam::Stopwatch watch;
  const auto gicp = slam::make_pcl_gicp({.max_distance_m = any_distance_m}, 0.0);
  gicp->set_target(thinned(target_T));
  const slam::PclMatch match = gicp->match(thinned(source_S), Pose{});
  return {match.X_TS, watch.cpu_ms()};
}

}  // namespace plumbline::scenarios
