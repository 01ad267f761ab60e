// SPDX-License-Identifier: Apache-2.0
#include "bim/model/walked_floors.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

/// Lower floor, a slope up to an upper one with a well in it, and a step on that.
WalkedFloors floors() {
  WalkedFloors floors{-0.5, {}};
  floors.raised.push_back({{rectangle(4, 0, 8, 5), {}}, 0.0, -1.0, {0.125, 0.0}});
  floors.raised.push_back({{rectangle(8, 0, 12, 5), {rectangle(9, 1, 10, 2)}}, 0.0, 0.0});
  floors.raised.push_back({{rectangle(11, 0, 12, 5), {}}, 0.15, 0.15});
  return floors;
}

TEST(WalkedFloors, HaveTheHeightOfTheHighestThatCoversAPoint) {
  const WalkedFloors lower_and_upper = floors();
  EXPECT_EQ(height_at(lower_and_upper, {2.0, 2.0}), -0.5);
  EXPECT_DOUBLE_EQ(height_at(lower_and_upper, {6.0, 2.0}), -0.25);
  EXPECT_EQ(height_at(lower_and_upper, {8.5, 2.0}), 0.0);
  EXPECT_EQ(height_at(lower_and_upper, {9.5, 1.5}), -0.5) << "the well";
  EXPECT_EQ(height_at(lower_and_upper, {11.5, 2.0}), 0.15);
}

TEST(WalkedFloors, MovedHaveTheirHeightsWhereTheyWereMoved) {
  const Stream stream(7, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto draw = [&](double low, double high, std::uint32_t lane, std::uint32_t k) {
      return low + (high - low) * stream.uniform(i, lane, k);
    };
    const Pose X_VW =
        Pose::from_xyz_yaw({draw(-50, 50, 0, 0), draw(-50, 50, 0, 1), draw(-50, 50, 0, 2)}, draw(-3.1, 3.1, 0, 3));
    const WalkedFloors there = moved(X_VW, floors());
    for (std::uint32_t k = 1; k < 20; ++k) {
      const Eigen::Vector3d p(draw(-1, 13, k, 0), draw(-1, 6, k, 1), 0.0);
      EXPECT_NEAR(height_at(there, (X_VW * p).head<2>()), height_at(floors(), p.head<2>()) + X_VW.t.z(), 1e-9)
          << p.transpose();
    }
  }
}

}  // namespace
}  // namespace plumbline::bim
