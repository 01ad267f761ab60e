// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/ransac.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

DeskewedScan standing(double length, double width, const synthetic::WalkConfig& walk) {
  MotionBuffer motion;
  motion.add({0, Pose{}});
  const Pose X_WR = Pose::from_xyz_yaw({0.4 * length, 0.5 * width, 0.46}, 0.3);
  return deskew(synthetic::standing_scan(synthetic::one_room(length, width), X_WR, walk), motion,
                synthetic::calibration());
}

synthetic::WalkConfig clean() {
  synthetic::WalkConfig walk;
  walk.range_sigma_m = 0.002;
  walk.vibration = 0.0;
  return walk;
}

TEST(RansacPlanes, FindsTheFourWallsOfARoomFacingTheSensor) {
  const DeskewedScan scan = standing(8.0, 5.0, clean());
  const std::vector<PlaneObservation> planes = ransac_planes(scan, {}, {}, 1);
  std::vector<double> distances;
  for (const PlaneObservation& plane : planes) {
    EXPECT_GT(plane.plane_R.distance(scan.X_RL.t), 0.0);
    EXPECT_GE(plane.points, RansacConfig{}.min_inliers);
    if (plane.vertical) distances.push_back(plane.plane_R.d);
  }
  std::sort(distances.begin(), distances.end());
  ASSERT_EQ(distances.size(), 4U);
  // Bounds: the sensor's noise of 2 mm, averaged over 100 returns, on the lever of their spread.
  const std::vector<double> truth = {2.5, 2.5, 3.2, 4.8};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(distances[k], truth[k], 0.01);
}

TEST(RansacPlanes, DependOnScanAndSeedOnly) {
  const DeskewedScan scan = standing(6.0, 4.0, synthetic::WalkConfig{});
  const std::vector<PlaneObservation> a = ransac_planes(scan, {}, {}, 1), b = ransac_planes(scan, {}, {}, 1);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].plane_R.n, b[k].plane_R.n);
    EXPECT_EQ(a[k].plane_R.d, b[k].plane_R.d);
    EXPECT_EQ(a[k].points, b[k].points);
  }
}

// The band of 1 cm of the papers' code is narrower than a VLP-16's noise: walls come out in slices.
TEST(RansacPlanes, SplitWallsWhereTheBandIsNarrowerThanTheNoise) {
  synthetic::WalkConfig walk = clean();
  walk.range_sigma_m = 0.02;
  const DeskewedScan scan = standing(8.0, 5.0, walk);
  RansacConfig wide;
  wide.distance_m = 0.06;
  const auto walls = [](const std::vector<PlaneObservation>& planes) {
    return std::count_if(planes.begin(), planes.end(), [](const PlaneObservation& p) { return p.vertical; });
  };
  EXPECT_EQ(walls(ransac_planes(scan, wide, {}, 1)), 4);
  EXPECT_GT(walls(ransac_planes(scan, {}, {}, 1)), 4);
}

TEST(RansacPlanes, TakeScansWithFewOrNoReturns) {
  DeskewedScan scan = standing(6.0, 4.0, clean());
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (i >= 90) scan.range_m[i] = 0.0;
  EXPECT_TRUE(ransac_planes(scan, {}, {}, 1).empty());
  std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0);
  EXPECT_TRUE(ransac_planes(scan, {}, {}, 1).empty());
  // All returns on one line span no plane.
  scan.range_m.assign(scan.range_m.size(), 5.0);
  for (std::size_t i = 0; i < scan.point_R.size(); ++i)
    scan.point_R[i] = {0.11 * static_cast<double>(i % 400), 2.0, 0.0};
  EXPECT_NO_THROW(static_cast<void>(ransac_planes(scan, {}, {}, 1)));
}

}  // namespace
}  // namespace plumbline::slam
