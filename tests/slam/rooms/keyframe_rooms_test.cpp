// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/keyframe_rooms.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

PlaneNode wall(int id, const Eigen::Vector2d& n, const Eigen::Vector2d& p0, const Eigen::Vector2d& p1) {
  return {id, Plane{{n.x(), n.y(), 0.0}, -n.dot(p0)}, p0, p1, 0.0, 2.5, 1};
}

/// A room of 6 x 4 m round (3, 2).
std::vector<PlaneNode> room_walls() {
  return {wall(0, {1, 0}, {0, 0}, {0, 4}), wall(1, {-1, 0}, {6, 0}, {6, 4}), wall(2, {0, 1}, {0, 0}, {6, 0}),
          wall(3, {0, -1}, {0, 4}, {6, 4})};
}

TEST(KeyframeRooms, FourWallsRoundTheRobotAreARoom) {
  const std::vector<RoomCandidate> rooms = keyframe_rooms(room_walls(), {1.0, 1.0}, {});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].kind, RoomKind::four_wall);
  EXPECT_EQ(rooms[0].planes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_LT((rooms[0].center_M - Eigen::Vector2d(3, 2)).norm(), 1e-12);
  EXPECT_NEAR(signed_area(rooms[0].polygon_M), 24.0, 1e-9);
}

TEST(KeyframeRooms, OnePairIsATwoWallRoomAlongBothOfItsWalls) {
  std::vector<PlaneNode> walls = room_walls();
  walls[2].p1 = {3.5, 0};
  walls.erase(walls.begin());
  const std::vector<RoomCandidate> rooms = keyframe_rooms(walls, {1.0, 1.0}, {});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].kind, RoomKind::two_wall);
  EXPECT_EQ(rooms[0].planes, (std::vector<int>{2, 3}));
  EXPECT_NEAR(signed_area(rooms[0].polygon_M), 14.0, 1e-9);
}

TEST(KeyframeRooms, NeedTheRobotBetweenWallsThatFaceIt) {
  EXPECT_TRUE(keyframe_rooms(room_walls(), {8.0, 5.0}, {}).empty());
  const std::vector<PlaneNode> one_side = {room_walls()[0], room_walls()[2]};
  EXPECT_TRUE(keyframe_rooms(one_side, {1.0, 1.0}, {}).empty());
}

TEST(KeyframeRooms, AWallBeyondTheOthersEndsDoesNotClose) {
  std::vector<PlaneNode> walls = room_walls();
  walls[1] = wall(1, {-1, 0}, {6, 7}, {6, 11});  // opposed, but past the side wall at y = 4
  const std::vector<RoomCandidate> rooms = keyframe_rooms(walls, {1.0, 1.0}, {});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].kind, RoomKind::two_wall);
}

}  // namespace
}  // namespace plumbline::slam
