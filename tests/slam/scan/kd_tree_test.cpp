// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

TEST(KdTree, AgreesWithBruteForce) {
  const Stream stream(3, "bim.generate");
  const auto at = [&](std::uint64_t tick, std::uint32_t i) {
    return Eigen::Vector3d(stream.uniform(tick, i, 0), stream.uniform(tick, i, 1), stream.uniform(tick, i, 2));
  };
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < 300; ++i) points.push_back(at(0, i));
  const KdTree tree(points);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = at(1, i);
    std::vector<double> brute;
    for (const Eigen::Vector3d& q : points) brute.push_back((p - q).squaredNorm());
    std::sort(brute.begin(), brute.end());
    const auto near = tree.nearest(p, 5);
    ASSERT_EQ(near.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(near[k].distance2, brute[k], 1e-12);
      EXPECT_NEAR((points[near[k].index] - p).squaredNorm(), brute[k], 1e-12);
    }
  }
}

TEST(KdTree, GivesWhatThereIs) {
  EXPECT_TRUE(KdTree({}).nearest(Eigen::Vector3d::Zero(), 3).empty());
  EXPECT_EQ(KdTree({{1, 2, 3}}).nearest(Eigen::Vector3d::Zero(), 3).size(), 1U);
}

}  // namespace
}  // namespace plumbline::slam
