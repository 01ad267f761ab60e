// SPDX-License-Identifier: Apache-2.0
#include "slam/pcl/pcl_cloud.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

Scan some_scan() {
  return synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({2.5, 1.5, 0.46}, 0.4), {});
}

DeskewedScan deskewed(const Scan& scan) {
  MotionBuffer motion;
  motion.add({0, Pose{}});
  return deskew(scan, motion, synthetic::calibration());
}

/// Returns of the first are those of the second, in their columns and rings.
void expect_same_returns(const Scan& a, const Scan& b) {
  ASSERT_EQ(a.rings, b.rings);
  ASSERT_EQ(a.columns, b.columns);
  int returns = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.range_m[i] > 0.0, b.range_m[i] > 0.0) << i;
    if (!(a.range_m[i] > 0.0)) continue;
    ++returns;
    EXPECT_LT((a.point_L[i] - b.point_L[i]).norm(), 1e-5) << i;  // floats at 10 m
    EXPECT_EQ(a.reflectivity[i], b.reflectivity[i]) << i;
  }
  EXPECT_GT(returns, 20000);
}

TEST(PclCloud, AScanComesBackWithItsReturns) {
  const Scan scan = some_scan();
  const pcl::PointCloud<pcl::PointXYZI> cloud = pcl_cloud(scan);
  EXPECT_EQ(cloud.width, 16U);
  EXPECT_EQ(cloud.height, static_cast<std::uint32_t>(scan.columns));
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_EQ(cloud.header.stamp, static_cast<std::uint64_t>(scan.stamp / 1000));
  const Scan back = scan_of(cloud, 7);
  expect_same_returns(scan, back);
  EXPECT_EQ(back.stamp, 7) << "without times all is at the stamp";
}

TEST(PclCloud, WithTimesAScanComesBackWithThem) {
  const Scan scan = some_scan();
  const Nanoseconds first = scan.stamp + *std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
  const pcl::PointCloud<PointXYZIRT> cloud = pcl_cloud_with_times(scan);
  EXPECT_EQ(cloud[17].ring, 1);
  const Scan back = scan_of(cloud, first);
  expect_same_returns(scan, back);
  EXPECT_NEAR(static_cast<double>(back.stamp), static_cast<double>(scan.stamp), 10.0);
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0) {
      EXPECT_NEAR(back.offset_ns[i], scan.offset_ns[i], 20) << i;
    }
}

TEST(PclCloud, ADeskewedScanIsInTheRobotsFrame) {
  const Scan scan = some_scan();
  const DeskewedScan moved = deskewed(scan);
  const pcl::PointCloud<pcl::PointXYZI> cloud = pcl_cloud(moved);
  ASSERT_EQ(cloud.size(), scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (moved.range_m[i] > 0.0) {
      EXPECT_EQ(cloud[i].getVector3fMap(), Eigen::Vector3f(moved.point_R[i].cast<float>())) << i;
    } else {
      EXPECT_TRUE(std::isnan(cloud[i].x)) << i;
    }
}

TEST(PclCloud, NothingIsAScanWithoutColumns) {
  EXPECT_EQ(pcl_cloud(Scan{}).size(), 0U);
  EXPECT_EQ(pcl_cloud_with_times(Scan{}).size(), 0U);
  EXPECT_EQ(pcl_cloud(std::span<const Eigen::Vector3d>{}).size(), 0U);
  EXPECT_EQ(scan_of(pcl_cloud(Scan{}), 5).columns, 0);
  EXPECT_EQ(scan_of(pcl_cloud(Scan{}), 5).stamp, 5);
}

}  // namespace
}  // namespace plumbline::slam
