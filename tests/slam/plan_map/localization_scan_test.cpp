// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/localization_scan.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

bim::PlanRoom room_of_height(double height_m, double area_m2) {
  bim::PlanRoom room;
  room.z0 = 1.0;
  room.z1 = 1.0 + height_m;
  room.polygon = {{0.0, 0.0}, {area_m2, 0.0}, {area_m2, 1.0}, {0.0, 1.0}};
  return room;
}

// In a parking deck of 2.4 m ceilings passed as walls, and right poses were lost.
TEST(WallHeight, StaysBelowLowCeilings) {
  const LocalizationScanConfig config;
  bim::Plan plan;
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms = {room_of_height(3.0, 50.0)};
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms.push_back(room_of_height(2.0, 5.0));  // below a stair
  EXPECT_EQ(wall_height(plan, config), config.max_height_m);
  plan.rooms.push_back(room_of_height(2.4, 20.0));
  EXPECT_NEAR(wall_height(plan, config), 2.32, 1e-12);
}

}  // namespace
}  // namespace plumbline::slam
