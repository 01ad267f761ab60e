// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include "slam/planes/sac_segmentation.h"

#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <memory>

#include "slam/io/clouds/quiet_pcl.h"
#include "slam/pcl/pcl_cloud.h"

namespace plumbline::slam {

std::optional<SacPlane> sac_plane(std::span<const Eigen::Vector3d> points, double distance_m, int iterations,
                                  double confidence) {
  constexpr std::size_t sample = 3;
  if (points.size() < sample) return std::nullopt;
  quiet_pcl();
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;  // one thread, no random seed: its defaults
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setDistanceThreshold(distance_m);
  segmentation.setMaxIterations(iterations);
  segmentation.setProbability(confidence);
  segmentation.setInputCloud(std::make_shared<const pcl::PointCloud<pcl::PointXYZ>>(pcl_cloud(points)));
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  segmentation.segment(inliers, plane);
  if (inliers.indices.size() < sample || plane.values.size() != 4) return std::nullopt;

  SacPlane result;
  const Eigen::Vector3d n(plane.values[0], plane.values[1], plane.values[2]);
  const double size = n.norm();
  if (!(size > 0.5) || !(size < 2.0)) return std::nullopt;
  result.plane = {n / size, plane.values[3] / size};
  result.inliers.assign(inliers.indices.begin(), inliers.indices.end());
  std::sort(result.inliers.begin(), result.inliers.end());
  return result;
}

}  // namespace plumbline::slam
