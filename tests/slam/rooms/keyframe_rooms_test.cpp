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

/// Four walls round a room with a corner at the origin.
std::vector<PlaneNode> walls_of(double length, double width) {
  return {wall(0, {1, 0}, {0, 0}, {0, width}), wall(1, {-1, 0}, {length, 0}, {length, width}),
          wall(2, {0, 1}, {0, 0}, {length, 0}), wall(3, {0, -1}, {0, width}, {length, width})};
}

std::vector<RoomCandidate> by_end_points(const std::vector<PlaneNode>& walls, const Eigen::Vector2d& robot) {
  return keyframe_rooms(walls, robot, {}, {.rule = KeyframeRoomRule::end_points});
}

TEST(RoomsOf2022, HaveWindowsOfWidth) {
  const std::vector<RoomCandidate> rooms = by_end_points(walls_of(4.0, 5.0), {1.0, 1.0});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].kind, RoomKind::four_wall);
  EXPECT_LT((rooms[0].center_M - Eigen::Vector2d(2.0, 2.5)).norm(), 0.02);
  EXPECT_TRUE(by_end_points(walls_of(7.0, 7.0), {1.0, 1.0}).empty());
}

TEST(RoomsOf2022, CorridorsAreOneAndAHalfToTwoAndAHalfMetresWide) {
  const auto corridor = [](double width) {
    return std::vector<PlaneNode>{wall(0, {0, 1}, {0, 0}, {12, 0}), wall(1, {0, -1}, {0, width}, {12, width})};
  };
  const std::vector<RoomCandidate> rooms = by_end_points(corridor(2.0), {3.0, 1.0});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].kind, RoomKind::two_wall);
  EXPECT_TRUE(by_end_points(corridor(2.6), {3.0, 1.0}).empty());
  EXPECT_TRUE(by_end_points(corridor(1.4), {3.0, 0.7}).empty());
}

TEST(RoomsOf2022, EndsMustBeNear) {
  std::vector<PlaneNode> walls = walls_of(4.0, 5.0);
  walls[1].p0.y() += 4.0;
  walls[1].p1.y() += 4.0;
  EXPECT_TRUE(by_end_points(walls, {1.0, 1.0}).empty());
}

// Of two walls behind each other the one whose ends are nearest, whatever their length.
TEST(RoomsOf2022, TheNearestEndsWin) {
  std::vector<PlaneNode> walls = walls_of(4.0, 5.0);
  walls.push_back(wall(4, {-1, 0}, {5.5, -1.0}, {5.5, 5.5}));
  const std::vector<RoomCandidate> rooms = by_end_points(walls, {1.0, 1.0});
  ASSERT_EQ(rooms.size(), 1U);
  EXPECT_EQ(rooms[0].planes, (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace plumbline::slam
