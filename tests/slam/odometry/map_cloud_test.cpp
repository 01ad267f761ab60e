// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/map_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace plumbline::slam
