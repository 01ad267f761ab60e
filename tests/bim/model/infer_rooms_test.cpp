// SPDX-License-Identifier: Apache-2.0
#include "bim/model/infer_rooms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"

namespace plumbline::bim {
namespace {

Wall wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Wall w;
  w.storey = 0;
  w.a = a;
  w.b = b;
  w.offset_m = -0.1;
  w.thickness_m = 0.2;
  return w;
}

/// Outer walls 8 x 5 about the centre lines, one wall between at x = split, all turned by yaw.
Building two_rooms(double split, double yaw, double gap) {
  const Eigen::Rotation2Dd R(yaw);
  const auto p = [&](double x, double y) -> Eigen::Vector2d { return R * Eigen::Vector2d(x, y); };
  Building building;
  building.storeys.push_back({"s", "s", 0.0, 3.0, 0});
  building.walls = {wall(p(0, 0), p(8, 0)), wall(p(8, 0), p(8, 5)), wall(p(8, 5), p(0, 5)), wall(p(0, 5), p(0, 0)),
                    wall(p(split, 0.1 + gap), p(split, 4.9 - gap))};
  return building;
}

/// The 2D booleans snap to 0.1 mm, and the outline is about 18 m long.
constexpr double area_tolerance_m2 = 18.0 * 1e-4;

TEST(InferRooms, FindsBothSidesOfAWallAtAnyYawAndThroughSmallGaps) {
  const Stream stream(7, "bim.generate");
  for (std::uint64_t i = 0; i < 50; ++i) {
    const double split = 1.0 + 6.0 * stream.uniform(i, 0);
    const double yaw = 6.28 * stream.uniform(i, 1);
    const std::vector<Room> rooms = infer_rooms(two_rooms(split, yaw, 0.0), 0);
    ASSERT_EQ(rooms.size(), 2u) << i;
    const double a = signed_area(rooms[0].polygon), b = signed_area(rooms[1].polygon);
    const double left = (split - 0.2) * 4.8, right = (8.0 - split - 0.2) * 4.8;
    EXPECT_NEAR(std::min(a, b), std::min(left, right), area_tolerance_m2);
    EXPECT_NEAR(std::max(a, b), std::max(left, right), area_tolerance_m2);
    // Walls that stop short by up to twice the closing distance still part the rooms.
    EXPECT_EQ(infer_rooms(two_rooms(split, yaw, 0.15), 0).size(), 2u);
  }
}

TEST(InferRooms, OpenWallsEncloseNothing) {
  Building building = two_rooms(4.0, 0.0, 0.0);
  building.walls.resize(3);
  EXPECT_TRUE(infer_rooms(building, 0).empty());
}

TEST(InferRooms, WideGapMakesOneRoom) { EXPECT_EQ(infer_rooms(two_rooms(4.0, 0.3, 0.5), 0).size(), 1u); }

TEST(InferRooms, LowStoreysHaveNone) {
  Building building = two_rooms(4.0, 0.0, 0.0);
  building.storeys.front().height_m = 1.25;
  EXPECT_TRUE(infer_rooms(building, 0).empty());
}

}  // namespace
}  // namespace plumbline::bim
