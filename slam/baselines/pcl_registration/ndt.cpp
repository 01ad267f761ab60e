// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include <pcl/registration/ndt.h>

#include "slam/baselines/pcl_registration/matcher_by.h"
#include "slam/io/clouds/quiet_pcl.h"
#include "slam/pcl/pcl_cloud.h"

// As the library holds it.
extern template class pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ, float>;

namespace plumbline::slam {

std::unique_ptr<PclMatcher> make_pcl_ndt(const PclNdtConfig& config, double matched_m) {
  quiet_pcl();
  using Ndt = pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>;
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  auto matcher = std::make_unique<MatcherBy<Ndt, Cloud>>(
      matched_m, 0, [](std::span<const Eigen::Vector3d> points) { return pcl_cloud(points); });
  Ndt& ndt = matcher->registration();
  ndt.setResolution(static_cast<float>(config.cell_m));
  ndt.setStepSize(config.step_m);
  ndt.setOulierRatio(config.outlier_share);
  ndt.setMaximumIterations(config.max_iterations);
  ndt.setTransformationEpsilon(config.epsilon_m2);
  return matcher;
}

}  // namespace plumbline::slam
