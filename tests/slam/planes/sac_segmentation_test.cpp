// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/sac_segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bim/random/stream.h"
#include "slam/planes/ransac.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// 300 points of the plane z = 1 with 2 mm of noise, then 60 anywhere.
std::vector<Eigen::Vector3d> a_plane_and_clutter() {
  const Stream stream(3, "slam.ransac");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t k = 0; k < 360; ++k) {
    const double u = 4.0 * stream.uniform(k, 0, 0), v = 3.0 * stream.uniform(k, 0, 1), w = stream.uniform(k, 0, 2);
    points.emplace_back(u, v, k < 300 ? 1.0 + 0.004 * (w - 0.5) : 2.0 * w);
  }
  return points;
}

TEST(SacPlane, FindsThePlaneOfMostPoints) {
  const std::vector<Eigen::Vector3d> points = a_plane_and_clutter();
  const auto found = sac_plane(points, 0.01, 500, 0.99);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(std::abs(found->plane.n.z()), 0.99999);
  EXPECT_NEAR(std::abs(found->plane.d), 1.0, 1e-3);
  EXPECT_NEAR(found->plane.n.norm(), 1.0, 1e-12);
  EXPECT_TRUE(std::is_sorted(found->inliers.begin(), found->inliers.end()));
  EXPECT_GE(found->inliers.size(), 300U);
  EXPECT_LE(found->inliers.size(), 305U);
  for (const std::uint32_t i : found->inliers) EXPECT_LE(std::abs(found->plane.distance(points[i])), 0.0101);
}

TEST(SacPlane, IsTheSameEachTime) {
  const std::vector<Eigen::Vector3d> points = a_plane_and_clutter();
  const auto a = sac_plane(points, 0.01, 50, 0.99), b = sac_plane(points, 0.01, 50, 0.99);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->plane.n, b->plane.n);
  EXPECT_EQ(a->plane.d, b->plane.d);
  EXPECT_EQ(a->inliers, b->inliers);
}

TEST(SacPlane, NeedsThreePointsThatSpanOne) {
  EXPECT_FALSE(sac_plane({}, 0.01, 50, 0.99).has_value());
  const std::vector<Eigen::Vector3d> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(sac_plane(two, 0.01, 50, 0.99).has_value());
  const std::vector<Eigen::Vector3d> same(40, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(sac_plane(same, 0.01, 50, 0.99).has_value());
}

TEST(RansacPlanes, OfPclAreThoseOfTheRoom) {
  synthetic::WalkConfig walk;
  walk.range_sigma_m = 0.002;
  walk.vibration = 0.0;
  MotionBuffer motion;
  motion.add({0, Pose{}});
  const Pose X_WR = Pose::from_xyz_yaw({3.2, 2.5, 0.46}, 0.3);
  const DeskewedScan scan =
      deskew(synthetic::standing_scan(synthetic::one_room(8.0, 5.0), X_WR, walk), motion, synthetic::calibration());
  RansacConfig config;
  config.source = RansacSource::pcl;
  const std::vector<PlaneObservation> planes = ransac_planes(scan, config, {}, 1);
  std::vector<double> distances;
  for (const PlaneObservation& plane : planes) {
    EXPECT_GT(plane.plane_R.distance(scan.X_RL.t), 0.0);
    if (plane.vertical) distances.push_back(plane.plane_R.d);
  }
  std::sort(distances.begin(), distances.end());
  ASSERT_EQ(distances.size(), 4U);
  constexpr std::array<double, 4> truth = {2.5, 2.5, 3.2, 4.8};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(distances[k], truth[k], 0.01);
  const std::vector<PlaneObservation> other_seed = ransac_planes(scan, config, {}, 2);
  ASSERT_EQ(other_seed.size(), planes.size()) << "PCL's draws are its own";
  for (std::size_t k = 0; k < planes.size(); ++k) EXPECT_EQ(other_seed[k].plane_R.d, planes[k].plane_R.d);
}

}  // namespace
}  // namespace plumbline::slam
