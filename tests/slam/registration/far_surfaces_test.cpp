// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/far_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumbline::slam {
namespace {

constexpr double far_m = 30.0;

std::vector<Surfel> surfels_with_far(int all, int far) {
  std::vector<Surfel> surfels(static_cast<std::size_t>(all));
  for (int i = 0; i < all; ++i)
    surfels[static_cast<std::size_t>(i)].mean_R = {0.0, i < far ? far_m + 1.0 + i : 5.0, 1.0};
  return surfels;
}

TEST(FarSurfaces, FewFarSurfelsAreLeftOut) {
  const std::vector<Surfel> kept = without_few_far(surfels_with_far(100, 5), far_m);
  EXPECT_EQ(kept.size(), 95U);
  EXPECT_TRUE(std::all_of(kept.begin(), kept.end(), [](const Surfel& s) { return s.mean_R.norm() < far_m; }));
}

TEST(FarSurfaces, ManyFarSurfelsStayAllInOrder) {
  const std::vector<Surfel> all = surfels_with_far(100, 15), kept = without_few_far(all, far_m);
  ASSERT_EQ(kept.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(kept[i].mean_R, all[i].mean_R);
}

TEST(FarSurfaces, NoSurfelsStayNone) { EXPECT_TRUE(without_few_far({}, far_m).empty()); }

TEST(FarSurfaces, PointsAreKeptUpToTheRange) {
  const std::vector<Eigen::Vector3d> points = {{far_m - 0.1, 0, 0}, {0, far_m + 0.1, 0}, {1, 2, 3}};
  const std::vector<Eigen::Vector3d> kept = within(points, far_m);
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0], points[0]);
  EXPECT_EQ(kept[1], points[2]);
}

TEST(FarSurfaces, MedianDistanceIsThatOfTheMiddleSurfel) {
  EXPECT_EQ(median_distance({}), 0.0);
  EXPECT_NEAR(median_distance(surfels_with_far(9, 2)), std::hypot(5.0, 1.0), 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
