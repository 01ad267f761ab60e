// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/voxel.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

std::vector<Eigen::Vector3d> cloud(std::uint64_t seed, std::uint64_t count) {
  const Stream random(seed, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < count; ++i)
    points.emplace_back(10.0 * random.gauss(i, 0), 10.0 * random.gauss(i, 1), random.gauss(i, 2));
  return points;
}

TEST(VoxelTest, DownsamplingKeepsOneMeanPointInEachOccupiedVoxel) {
  const std::vector<Eigen::Vector3d> points = cloud(1, 5000);
  const std::vector<Eigen::Vector3d> thin = voxel_downsample(points, 0.5);
  std::vector<std::uint64_t> expected;
  for (const Eigen::Vector3d& p : points) expected.push_back(VoxelKey::of(p, 0.5).packed());
  std::sort(expected.begin(), expected.end());
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  std::vector<std::uint64_t> found;
  for (const Eigen::Vector3d& p : thin) found.push_back(VoxelKey::of(p, 0.5).packed());
  EXPECT_EQ(found, expected);
}

TEST(VoxelTest, OrderOfPointsDoesNotChangeTheVoxels) {
  std::vector<Eigen::Vector3d> points = cloud(2, 3000);
  const std::vector<Eigen::Vector3d> a = voxel_downsample(points, 0.3);
  std::reverse(points.begin(), points.end());
  const std::vector<Eigen::Vector3d> b = voxel_downsample(points, 0.3);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT((a[i] - b[i]).norm(), 1e-12);
}

TEST(VoxelTest, IndexFindsWhatWasInserted) {
  VoxelIndex index;
  const std::vector<Eigen::Vector3d> points = cloud(3, 20000);
  std::vector<int> slots;
  for (const Eigen::Vector3d& p : points) slots.push_back(index.insert(VoxelKey::of(p, 0.25)));
  EXPECT_EQ(*std::max_element(slots.begin(), slots.end()) + 1, index.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(index.find(VoxelKey::of(points[i], 0.25)), slots[i]);
  EXPECT_EQ(index.find({1000, 1000, 1000}), -1);
  index.clear();
  EXPECT_EQ(index.size(), 0);
  EXPECT_EQ(index.find(VoxelKey::of(points[0], 0.25)), -1);
}

TEST(VoxelTest, RefusesPointsBeyondItsKeys) { EXPECT_THROW((void)VoxelKey::of({1e9, 0.0, 0.0}, 0.1), InternalError); }

}  // namespace
}  // namespace plumbline::slam
