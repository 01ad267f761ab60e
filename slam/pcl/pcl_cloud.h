// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "slam/io/packets/point_cloud.h"
#include "slam/io/records.h"
#include "slam/scan/motion.h"

/// Scans as clouds of PCL and back. For sources of methods that use PCL: no other header includes this one.
namespace plumbline::slam {

/// A return with its laser and time, laid out as drivers of Velodyne LiDARs do.
struct EIGEN_ALIGN16 PointXYZIRT {
  PCL_ADD_POINT4D
  float intensity;     ///< 0-255
  std::uint16_t ring;  ///< 0: the lowest
  float time;          ///< since the scan's first return slot, s
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace plumbline::slam

POINT_CLOUD_REGISTER_POINT_STRUCT(plumbline::slam::PointXYZIRT,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity,
                                                                          intensity)(std::uint16_t, ring,
                                                                                     ring)(float, time, time))

namespace plumbline::slam {

namespace pcl_detail {

/// A row a firing, not-a-number where there is no return.
template <class Point>
pcl::PointCloud<Point> organised(int rings, int columns, Nanoseconds stamp) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Point none{};
  none.getVector4fMap() = Eigen::Vector4f(nan, nan, nan, 1.0F);
  pcl::PointCloud<Point> cloud(static_cast<std::uint32_t>(rings), static_cast<std::uint32_t>(columns), none);
  cloud.is_dense = false;
  cloud.header.stamp = static_cast<std::uint64_t>(stamp / 1000);
  return cloud;
}

/// The scan of what lies in the points' bytes.
template <class Point>
Scan scan_of_bytes(const pcl::PointCloud<Point>& cloud, Nanoseconds stamp, std::vector<PointField> fields) {
  PointCloud bytes;
  bytes.stamp = stamp;
  bytes.width = cloud.width;
  bytes.height = cloud.height;
  bytes.point_step = sizeof(Point);
  bytes.row_step = bytes.width * bytes.point_step;
  bytes.fields = std::move(fields);
  bytes.data.resize(cloud.size() * sizeof(Point));
  if (!cloud.empty()) std::memcpy(bytes.data.data(), cloud.points.data(), bytes.data.size());
  return scan_of(bytes);
}

}  // namespace pcl_detail

/// Points in their own frame, rounded to float.
[[nodiscard]] inline pcl::PointCloud<pcl::PointXYZ> pcl_cloud(std::span<const Eigen::Vector3d> points) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.reserve(points.size());
  for (const Eigen::Vector3d& p : points)
    cloud.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return cloud;
}

/// In L; a row a firing, not-a-number where there is no return; intensity: reflectivity. The header's stamp, in us, is
/// the scan's.
[[nodiscard]] inline pcl::PointCloud<pcl::PointXYZI> pcl_cloud(const Scan& scan) {
  auto cloud = pcl_detail::organised<pcl::PointXYZI>(scan.rings, scan.columns, scan.stamp);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!(scan.range_m[i] > 0.0)) continue;
    cloud[i].getVector3fMap() = scan.point_L[i].cast<float>();
    cloud[i].intensity = scan.reflectivity[i];
  }
  return cloud;
}

/// In R at the scan's stamp; a row a firing, not-a-number where there is no return; intensity 0, which a deskewed scan
/// does not keep.
[[nodiscard]] inline pcl::PointCloud<pcl::PointXYZI> pcl_cloud(const DeskewedScan& scan) {
  auto cloud = pcl_detail::organised<pcl::PointXYZI>(scan.rings, scan.columns, scan.stamp);
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] > 0.0) cloud[i].getVector3fMap() = scan.point_R[i].cast<float>();
  return cloud;
}

/// As pcl_cloud(Scan), with laser and time of each return slot.
[[nodiscard]] inline pcl::PointCloud<PointXYZIRT> pcl_cloud_with_times(const Scan& scan) {
  auto cloud = pcl_detail::organised<PointXYZIRT>(scan.rings, scan.columns, scan.stamp);
  std::int32_t first = 0;
  for (const std::int32_t offset : scan.offset_ns) first = offset < first ? offset : first;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    PointXYZIRT& point = cloud[i];
    point.ring = static_cast<std::uint16_t>(i % static_cast<std::size_t>(scan.rings));
    point.time = static_cast<float>(1e-9 * static_cast<double>(scan.offset_ns[i] - first));
    if (!(scan.range_m[i] > 0.0)) continue;
    point.getVector3fMap() = scan.point_L[i].cast<float>();
    point.intensity = scan.reflectivity[i];
  }
  return cloud;
}

/// Back to a scan, as scan_of(PointCloud) takes a message with these fields. Without times all
/// returns are at `stamp`. Throws InputError without a mark.
[[nodiscard]] inline Scan scan_of(const pcl::PointCloud<pcl::PointXYZI>& cloud, Nanoseconds stamp) {
  return pcl_detail::scan_of_bytes(cloud, stamp,
                                   {{"x", offsetof(pcl::PointXYZI, x), PointType::f32},
                                    {"y", offsetof(pcl::PointXYZI, y), PointType::f32},
                                    {"z", offsetof(pcl::PointXYZI, z), PointType::f32},
                                    {"intensity", offsetof(pcl::PointXYZI, intensity), PointType::f32}});
}

/// stamp: of the first return slot.
[[nodiscard]] inline Scan scan_of(const pcl::PointCloud<PointXYZIRT>& cloud, Nanoseconds stamp) {
  return pcl_detail::scan_of_bytes(cloud, stamp,
                                   {{"x", offsetof(PointXYZIRT, x), PointType::f32},
                                    {"y", offsetof(PointXYZIRT, y), PointType::f32},
                                    {"z", offsetof(PointXYZIRT, z), PointType::f32},
                                    {"intensity", offsetof(PointXYZIRT, intensity), PointType::f32},
                                    {"ring", offsetof(PointXYZIRT, ring), PointType::u16},
                                    {"time", offsetof(PointXYZIRT, time), PointType::f32}});
}

}  // namespace plumbline::slam
