// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/registration_timing.h"

#if __has_include(<pcl/registration/gicp.h>)

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include <Eigen/Geometry>
#include <memory>

#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

constexpr float leaf_m = 0.25F;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr thinned(const std::vector<Eigen::Vector3f>& points) {
  const auto cloud = std::make_shared<Cloud>();
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setLeafSize(leaf_m, leaf_m, leaf_m);
  grid.setInputCloud(cloud);
  auto thin = std::make_shared<Cloud>();
  grid.filter(*thin);
  return thin;
}

}  // namespace

std::optional<Registered> register_pcl(const std::vector<Eigen::Vector3f>& target_T,
                                       const std::vector<Eigen::Vector3f>& source_S) {
  const slam::Stopwatch watch;
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
  gicp.setInputTarget(thinned(target_T));
  gicp.setInputSource(thinned(source_S));
  Cloud moved;
  gicp.align(moved);
  const Eigen::Matrix4d X = gicp.getFinalTransformation().cast<double>();
  const Eigen::Matrix3d R = X.topLeftCorner<3, 3>();
  return Registered{{Eigen::Quaterniond(R).normalized(), X.topRightCorner<3, 1>()}, watch.cpu_ms()};
}

}  // namespace plumbline::scenarios

#else

namespace plumbline::scenarios {

std::optional<Registered> register_pcl(const std::vector<Eigen::Vector3f>&, const std::vector<Eigen::Vector3f>&) {
  return {};
}

}  // namespace plumbline::scenarios

#endif
