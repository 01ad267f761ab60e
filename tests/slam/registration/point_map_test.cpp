// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/point_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam::loam {
namespace {

constexpr double tiny_leaf_m = 1e-3;  // so that every point stays a point of its own

std::vector<Eigen::Vector3d> cloud(std::uint64_t seed, std::uint64_t n) {
  const Stream draws(seed, "bim.generate");
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < n; ++i)
    points.emplace_back(6.0 * draws.uniform(i, 0) - 3.0, 6.0 * draws.uniform(i, 1) - 3.0,
                        3.0 * draws.uniform(i, 2) - 1.5);
  return points;
}

TEST(PointMapTest, FindsTheSameFiveAsLookingAtAll) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Eigen::Vector3d> points = cloud(seed, 800);
    PointMap map(tiny_leaf_m);
    for (const Eigen::Vector3d& p : points) map.add(p);
    int found = 0;
    for (const Eigen::Vector3d& query : cloud(seed + 100, 200)) {
      std::vector<Eigen::Vector3d> sorted = points;
      std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
        return (a - query).squaredNorm() < (b - query).squaredNorm();
      });
      PointMap::Neighbours near;
      const bool five = map.nearest(query, 0.49, near);
      ASSERT_EQ(five, (sorted[4] - query).squaredNorm() < 0.49);
      if (!five) continue;
      ++found;
      for (std::size_t k = 0; k < near.size(); ++k) EXPECT_EQ(near[k], sorted[k]);
    }
    EXPECT_GT(found, 50);
  }
}

TEST(PointMapTest, KeepsTheFirstPointOfALeaf) {
  PointMap map(0.4);
  for (int k = 0; k < 5; ++k) {
    map.add({0.41 * k + 0.1, 0.1, 0.1});
    map.add({0.41 * k + 0.2, 0.1, 0.1});
  }
  PointMap::Neighbours near;
  EXPECT_FALSE(map.nearest({0.8, 0.1, 0.1}, 0.25, near)) << "only three lie that near";
  ASSERT_TRUE(map.nearest({0.9, 0.1, 0.1}, 1.0, near));
  EXPECT_NEAR(near[0].x(), 0.92, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam::loam
