// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_crossing.h"

#include <gtest/gtest.h>

#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

/// Scans outside after each pose of a straight walk, 0.2 m apart, in W.
std::vector<int> outside_along(const PlanIndex& index, const Eigen::Vector2d& from_W, const Eigen::Vector2d& to_W) {
  RoomExit exit;
  std::vector<int> outside;
  const int steps = static_cast<int>((to_W - from_W).norm() / 0.2);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from_W + (to_W - from_W) * i / steps;
    const Pose2 X_IH = heading(index.X_WI.inverse() * Pose::from_xyz_yaw({p.x(), p.y(), 0.46}, 0.0));
    outside.push_back(exit.update(index.storeys[0], X_IH, index.config.body_height_m));
  }
  return outside;
}

TEST(RoomExit, CountsTheScansInNoRoomAfterAWall) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(synthetic::twin_rooms()), "ground", {});
  const std::vector<int> out = outside_along(index, {1.5, 1.4}, {1.5, -3.0});
  EXPECT_EQ(out.front(), 0);
  EXPECT_GE(out.back(), 10);
  for (std::size_t i = 1; i < out.size(); ++i) EXPECT_TRUE(out[i] == 0 || out[i] == out[i - 1] + 1);
}

TEST(RoomExit, CountsNothingWithinARoomOrBackInOne) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(synthetic::twin_rooms()), "ground", {});
  for (const int outside : outside_along(index, {1.5, 1.4}, {3.0, 2.4})) EXPECT_EQ(outside, 0);
  EXPECT_EQ(outside_along(index, {1.5, -2.0}, {1.5, 1.4}).back(), 0);
  EXPECT_EQ(outside_along(index, {1.5, 1.4}, {10.5, 2.4}).back(), 0) << "from one room to the other";
}

}  // namespace
}  // namespace plumbline::slam
