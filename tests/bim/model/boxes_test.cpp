// SPDX-License-Identifier: Apache-2.0
#include "bim/model/boxes.h"

#include <gtest/gtest.h>

namespace plumbline::bim {
namespace {

TEST(Boxes, HoldAllVerticesOfASolid) {
  Solid solid;
  EXPECT_TRUE(box_of(solid).isEmpty());
  solid.vertices = {{1.0, -2.0, 3.0}, {-1.0, 2.0, 0.5}, {0.0, 0.0, 4.0}};
  EXPECT_EQ(box_of(solid).min(), Eigen::Vector3d(-1.0, -2.0, 0.5));
  EXPECT_EQ(box_of(solid).max(), Eigen::Vector3d(1.0, 2.0, 4.0));
}

TEST(Boxes, NearAreThoseWithinTheMargin) {
  BoxIndex index;
  for (const double x : {0.0, 2.0, 5.0}) index.add({{x, 0.0}, {x + 1.0, 0.0}, {x + 1.0, 1.0}});
  const Polygon2 outline = {{1.5, 0.0}, {1.6, 0.0}, {1.6, 1.0}};
  EXPECT_EQ(index.near(outline, 0.45), std::vector<int>{1});
  EXPECT_EQ(index.near(outline, 0.55), (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace plumbline::bim
