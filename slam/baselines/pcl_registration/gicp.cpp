// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include <pcl/registration/gicp.h>

#include "slam/baselines/pcl_registration/matcher_by.h"
#include "slam/io/clouds/quiet_pcl.h"
#include "slam/pcl/pcl_cloud.h"

namespace plumbline::slam {

std::unique_ptr<PclMatcher> make_pcl_gicp(const PclGicpConfig& config, double matched_m) {
  quiet_pcl();
  using Gicp = pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>;
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  auto matcher = std::make_unique<MatcherBy<Gicp, Cloud>>(
      matched_m, static_cast<std::size_t>(config.neighbours),
      [](std::span<const Eigen::Vector3d> points) { return pcl_cloud(points); });
  Gicp& gicp = matcher->registration();
  gicp.setMaxCorrespondenceDistance(config.max_distance_m);
  gicp.setCorrespondenceRandomness(config.neighbours);
  gicp.setRotationEpsilon(config.rotation_epsilon);
  gicp.setTransformationEpsilon(config.translation_epsilon_m);
  gicp.setMaximumIterations(config.max_iterations);
  gicp.setMaximumOptimizerIterations(config.inner_iterations);
  return matcher;
}

}  // namespace plumbline::slam
