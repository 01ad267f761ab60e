// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/map_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace plumbline::slam {
namespace {

/// A wall of 2 x 2 m, a point each 4 cm, and points a metre before it, each alone.
CloudKeyframe cloud() {
  CloudKeyframe cloud;
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j)
      cloud.points_R.emplace_back(0.04F * static_cast<float>(i), 0.02F, 0.04F * static_cast<float>(j));
  for (int i = 0; i < 10; ++i)
    cloud.points_R.emplace_back(0.2F * static_cast<float>(i), -1.0F, 0.2F * static_cast<float>(i));
  return cloud;
}

TEST(MapCloud, EveryOtherIsKept) {
  for (const int count : {0, 1, 2, 7, 8}) {
    std::vector<int> all(static_cast<std::size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    keep_every_other(all);
    ASSERT_EQ(all.size(), static_cast<std::size_t>((count + 1) / 2));
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<int>(2 * i));
  }
}

TEST(MapCloud, OfOthersIsThinnedOnce) {
  std::vector<Eigen::Vector3f> dense;
  for (int i = 0; i < 300; ++i)
    for (int j = 0; j < 300; ++j)
      dense.emplace_back(0.01F * static_cast<float>(i), 0.02F, 0.01F * static_cast<float>(j));
  const std::vector<Eigen::Vector3f> thin = thin_map(dense);
  EXPECT_LT(thin.size(), dense.size() / 20);
  EXPECT_GT(thin.size(), dense.size() / 30);
  EXPECT_EQ(thin_map(thin), thin);
  const std::vector<CloudKeyframe> keyframes = {cloud()};
  const std::vector<Eigen::Vector3f> ours = map_cloud(keyframes, {});
  EXPECT_EQ(thin_map(ours), ours);
  EXPECT_TRUE(thin_map({}).empty());
}

TEST(MapCloud, StraysAreDropped) {
  const std::vector<CloudKeyframe> one = {cloud()};
  const auto strays = [](const std::vector<Eigen::Vector3f>& map) {
    return std::count_if(map.begin(), map.end(), [](const Eigen::Vector3f& p) { return p.y() < -0.5F; });
  };
  const std::vector<Eigen::Vector3f> all = map_cloud(one, {});
  const std::vector<Eigen::Vector3f> kept = map_cloud(one, {.min_neighbours = 8});
  EXPECT_EQ(strays(all), 10);
  EXPECT_EQ(strays(kept), 0);
  EXPECT_EQ(kept.size() + 10, all.size());  // a corner of the wall has eight voxels of it within two
}

TEST(MapCloud, WhatLiesOnALevelIsNoStray) {
  const std::vector<CloudKeyframe> one = {cloud()};
  const std::vector<Plane> level = {{Eigen::Vector3d::UnitZ(), -0.81}};  // through one of the ten
  const std::size_t without = map_cloud(one, {.min_neighbours = 8}).size();
  EXPECT_EQ(map_cloud(one, {.min_neighbours = 8}, level).size(), without + 1);
}

// Points two voxels apart have few neighbours: strays where beams lie dense, none where they spread with range.
TEST(MapCloud, LessIsAskedOfWhatWasSeenFromAfar) {
  const auto kept = [](float range_m) {
    CloudKeyframe far;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j)
        far.points_R.emplace_back(range_m, 0.1F * static_cast<float>(i) - 0.975F,
                                  0.1F * static_cast<float>(j) - 0.975F);
    return map_cloud(std::vector<CloudKeyframe>{far}, {.min_neighbours = 12, .dense_m = 4.0}).size();
  };
  EXPECT_EQ(kept(3.02F), 0U);
  EXPECT_GT(kept(12.02F), 300U);
}

TEST(MapCloud, RingsAreThinnedByThemselves) {
  DeskewedScan scan;
  scan.rings = 2;
  scan.columns = 40;
  for (int column = 0; column < scan.columns; ++column)
    for (int ring = 0; ring < scan.rings; ++ring) {
      scan.range_m.push_back(column == 20 ? 0.0 : 2.0);
      scan.point_R.emplace_back(2.0, 0.02 * column + 0.001, 0.001 * ring);
    }
  const CloudKeyframe thin = thin_rings(scan, {}, {.voxel_m = 0.1});
  ASSERT_EQ(thin.points_R.size(), 16U);  // 0.8 m a ring, both in the same voxels
  ASSERT_EQ(thin.lasers.size(), thin.points_R.size());
  EXPECT_EQ(std::count(thin.lasers.begin(), thin.lasers.end(), 1), 8);
  EXPECT_NEAR(static_cast<double>(thin.points_R[0].y()), 0.041, 1e-6);
  EXPECT_NEAR(static_cast<double>(thin.points_R[4].y()), 0.451, 1e-6);  // without the one that has no return
}

}  // namespace
}  // namespace plumbline::slam
