// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/voxel_hash_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bim/random/stream.h"

namespace plumbline::slam::kiss {
namespace {

/// Points in a cube of side_m around the origin.
std::vector<Eigen::Vector3d> points_in_cube(std::uint64_t count, double side_m) {
  const Stream random(3, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < count; ++i)
    points.emplace_back(side_m * (random.uniform(i, 0) - 0.5), side_m * (random.uniform(i, 1) - 0.5),
                        side_m * (random.uniform(i, 2) - 0.5));
  return points;
}

TEST(VoxelHashMap, RefusesThePointAfterTheLastOfAVoxel) {
  VoxelHashMap map(1.0, 20);  // points stand 0.224 m apart
  int added = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        const bool is_added = map.add({0.1 + 0.3 * x, 0.1 + 0.3 * y, 0.1 + 0.3 * z});
        EXPECT_EQ(is_added, added < 20);
        added += is_added ? 1 : 0;
      }
  EXPECT_EQ(added, 20);
  EXPECT_EQ(map.voxels(), 1U);
  EXPECT_TRUE(map.add({1.1, 0.1, 0.1})) << "the next voxel has room";
}

TEST(VoxelHashMap, RefusesPointsNearAnotherOfTheirVoxel) {
  VoxelHashMap map(2.0, 20);
  const double apart_m = 2.0 / std::sqrt(20.0);
  EXPECT_TRUE(map.add({0.1, 1.0, 1.0}));
  EXPECT_FALSE(map.add({0.1 + 0.999 * apart_m, 1.0, 1.0}));
  EXPECT_TRUE(map.add({0.1 + 1.001 * apart_m, 1.0, 1.0}));
  EXPECT_TRUE(map.add({-0.1, 1.0, 1.0})) << "the next voxel's points do not count";
}

TEST(VoxelHashMap, FindsTheNearestOfAllPointsWithinAVoxelSize) {
  constexpr double voxel_m = 0.5;
  VoxelHashMap map(voxel_m, 4);
  std::vector<Eigen::Vector3d> held;
  for (const Eigen::Vector3d& p : points_in_cube(600, 4.0))
    if (map.add(p)) held.push_back(p);
  ASSERT_GT(held.size(), 300U);
  int found = 0;
  for (const Eigen::Vector3d& q : points_in_cube(2000, 4.6)) {
    const Eigen::Vector3d p = q + Eigen::Vector3d(0.05, 0.03, -0.02);
    double least2 = voxel_m * voxel_m;
    for (const Eigen::Vector3d& h : held) least2 = std::min(least2, (h - p).squaredNorm());
    const Eigen::Vector3d* nearest = map.nearest(p, voxel_m * voxel_m);
    ASSERT_EQ(nearest != nullptr, least2 < voxel_m * voxel_m);
    if (nearest == nullptr) continue;
    EXPECT_EQ((*nearest - p).squaredNorm(), least2);
    ++found;
  }
  EXPECT_GT(found, 1000);
}

TEST(VoxelHashMap, LooksNoFartherThanAskedAndThanTheVoxelsAround) {
  VoxelHashMap map(1.0, 20);
  map.add({0.5, 0.5, 0.5});
  EXPECT_NE(map.nearest({1.5, 0.5, 0.5}, 1.01), nullptr);
  EXPECT_EQ(map.nearest({1.5, 0.5, 0.5}, 1.0), nullptr) << "the distance itself is excluded";
  EXPECT_NE(map.nearest({-0.99, 0.5, 0.5}, 100.0), nullptr);
  EXPECT_EQ(map.nearest({-1.01, 0.5, 0.5}, 100.0), nullptr) << "two voxels away";
}

TEST(VoxelHashMap, DropsVoxelsWhoseFirstPointIsFar) {
  VoxelHashMap map(1.0, 20);
  for (int k = 0; k < 30; ++k) {
    map.add({k + 0.5, 0.5, 0.5});
    map.add({k + 0.9, 0.5, 0.5});
  }
  map.drop_beyond({0.5, 0.5, 0.5}, 10.0);
  EXPECT_EQ(map.voxels(), 10U);  // 0 to 9 m away
  for (int k = 0; k < 30; ++k) {
    const Eigen::Vector3d p(k + 0.9, 0.5, 0.5);
    EXPECT_EQ(map.nearest(p, 1e-6) != nullptr, k < 10) << k;
  }
  EXPECT_TRUE(map.add({15.5, 0.5, 0.5}));
  ASSERT_NE(map.nearest({15.5, 0.5, 0.5}, 1.0), nullptr);
  map.drop_beyond({1000.0, 0.0, 0.0}, 10.0);
  EXPECT_TRUE(map.empty());
}

TEST(VoxelHashMap, RefusesWhatIsOutOfReachOrNoNumber) {
  VoxelHashMap map(1.0, 20);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  map.add({0.5, 0.5, 0.5});
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(map.reach_m(), 0.0, 0.0), Eigen::Vector3d(0.0, -1e30, 0.0),
                                   Eigen::Vector3d(0.0, 0.0, inf), Eigen::Vector3d(nan, 0.0, 0.0)}) {
    EXPECT_FALSE(map.add(p));
    EXPECT_EQ(map.nearest(p, 1e9), nullptr);
  }
  EXPECT_TRUE(map.add({0.999 * map.reach_m(), 0.0, 0.0}));
}

TEST(VoxelHashMap, IsBounded) {
  VoxelHashMap map(1.0, 1000);  // room for 8000 voxels
  int added = 0;
  for (int k = 0; k < 10'000; ++k) added += map.add({k + 0.5, 0.5, 0.5}) ? 1 : 0;
  EXPECT_EQ(static_cast<std::size_t>(added) * 1000, VoxelHashMap::most_points);
}

}  // namespace
}  // namespace plumbline::slam::kiss
