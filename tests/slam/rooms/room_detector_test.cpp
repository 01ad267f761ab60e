// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/room_detector.h"

#include <gtest/gtest.h>

#include "tests/slam/rooms/scene.h"

namespace plumbline::slam {
namespace {

// The rectangle round a bent hall covers two rooms beside it. It gives way to the one with four walls, and must not
// take the corridor with it.
TEST(RoomDetector, ARoomThatGivesWayDropsNoOther) {
  for (const double yaw : headings) {
    Scene scene{{{0, 0, 10, 3.5}, {0, 0, 4.5, 8}, {4.7, 3.7, 7.2, 8}, {7.4, 3.7, 10, 8}}, {}, {}, yaw};
    scene.faces = {{{0, 0}, {10, 0}},      {{10, 0}, {10, 3.5}}, {{10, 3.5}, {4.5, 3.5}},
                   {{4.5, 3.5}, {4.5, 8}}, {{4.5, 8}, {0, 8}},   {{0, 8}, {0, 0}}};
    scene.enclose({4.7, 3.7, 7.2, 8});
    scene.enclose({7.4, 3.7, 10, 8}, {0, 2});
    RoomConfig config;
    config.polygons = false;  // as of a hall of more walls than a room may have
    const FreeGrid grid = scene.grid();
    const std::vector<RoomCandidate> rooms =
        detect_rooms(grid, clusters(grid, {}), scene.walls(), scene.at({{2, 2}, {6, 6}, {9, 6}}), config);
    ASSERT_EQ(rooms.size(), 2U) << yaw;
    EXPECT_NE(rooms[0].kind, rooms[1].kind);
    for (const RoomCandidate& room : rooms) EXPECT_NEAR(signed_area(room.polygon_M), 11.0, 1.0) << yaw;
  }
}

}  // namespace
}  // namespace plumbline::slam
