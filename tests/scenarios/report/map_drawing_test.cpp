// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/map_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::scenarios {
namespace {

TEST(RoomNamePlace, IsTheUpperLeftCornerOfARectangle) {
  const RoomNamePlace place = room_name_place({{1.0, 2.0}, {5.0, 2.0}, {5.0, 6.0}, {1.0, 6.0}});
  EXPECT_LT((place.from - Eigen::Vector2d(1.2, 5.55)).norm(), 1e-12);
  EXPECT_NEAR(place.width_m, 3.7, 1e-12);
}

TEST(RoomNamePlace, IsInTheWideLegOfAnL) {
  // Another room lies where the corner of the box around it is.
  const Polygon2 room = {{0.0, 0.0}, {6.0, 0.0}, {6.0, 6.0}, {5.0, 6.0}, {5.0, 3.0}, {0.0, 3.0}};
  const RoomNamePlace place = room_name_place(room);
  EXPECT_TRUE(contains(room, place.from));
  EXPECT_LT(place.from.y(), 3.0);
  EXPECT_NEAR(place.width_m, 5.7, 1e-12);
}

TEST(RoomNamePlace, IsInRoomsOfAnyDirectionAndShape) {
  const Stream stream(3, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    Polygon2 room;
    const int corners = 3 + static_cast<int>(6.0 * stream.uniform(i, 0));
    const double turn = 6.0 * stream.uniform(i, 1);
    for (int k = 0; k < corners; ++k) {
      const double angle = turn + 2.0 * std::numbers::pi * k / corners;
      room.emplace_back(3.0 + 4.0 * std::cos(angle), -2.0 + 2.0 * std::sin(angle));
    }
    const RoomNamePlace place = room_name_place(room);
    EXPECT_TRUE(contains(room, place.from)) << i;
    EXPECT_TRUE(contains(room, place.from + Eigen::Vector2d(place.width_m, 0.0))) << i;
    EXPECT_GT(place.width_m, 1.0) << i;
  }
}

}  // namespace
}  // namespace plumbline::scenarios
