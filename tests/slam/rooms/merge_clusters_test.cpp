// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/merge_clusters.h"

#include <gtest/gtest.h>

#include "tests/slam/rooms/scene.h"

namespace plumbline::slam {
namespace {

/// A corridor of 1.8 x 10 m with something of this depth along it in the middle, which leaves 0.9 m.
Scene corridor_with(double depth_m, double yaw) {
  Scene scene{{{0, 0, 1.8, 10}}, {{0, 5 - 0.5 * depth_m, 0.9, 5 + 0.5 * depth_m}}, {}, yaw};
  scene.enclose({0, 0, 1.8, 10});
  scene.faces.push_back({{0.9, 5 - 0.5 * depth_m}, {0, 5 - 0.5 * depth_m}});
  scene.faces.push_back({{0, 5 + 0.5 * depth_m}, {0.9, 5 + 0.5 * depth_m}});
  return scene;
}

TEST(MergeClusters, GoOnPastACupboardAndEndAtAPartition) {
  for (const double yaw : headings) {
    for (const double depth_m : {0.8, 1.0}) {
      const FreeGrid grid = corridor_with(depth_m, yaw).grid();
      ASSERT_EQ(clusters(grid, {}).size(), 2U) << yaw;
      EXPECT_EQ(corridor_with(depth_m, yaw).rooms({{1.3, 2}, {1.3, 8}}).size(), 1U) << depth_m << " yaw " << yaw;
    }
    EXPECT_EQ(corridor_with(0.15, yaw).rooms({{1.3, 2}, {1.3, 8}}).size(), 2U) << yaw;
  }
}

TEST(MergeClusters, WideTakesTheClustersThatTouchOverMoreThanADoor) {
  const FreeGrid grid = Scene{{{0, 0, 10, 10}}, {}, {}, 0.0}.grid();
  std::vector<std::size_t> parts[3];
  for (std::size_t k = 0; k < grid.free.size(); ++k) {
    if (grid.free[k] == 0) continue;
    const Eigen::Vector2d p = grid.frame.center(k) - Eigen::Vector2d(13, 9);
    parts[p.x() < 4 ? 0 : p.y() < 8.8 ? 1 : 2].push_back(k);
  }
  // The first touches the second over 8.8 m and the third over 1.2 m, the second the third over 6 m.
  const std::vector<Cluster> three = {cluster_of(grid, parts[0]), cluster_of(grid, parts[1]),
                                      cluster_of(grid, parts[2])};
  EXPECT_EQ(merge_wide(grid, three, 9.0).size(), 0U);
  const std::vector<Cluster> two = merge_wide(grid, three, 7.0);
  ASSERT_EQ(two.size(), 1U);
  EXPECT_EQ(two[0].cells.size(), parts[0].size() + parts[1].size());
  EXPECT_NEAR(merge_wide(grid, three, 1.6)[0].area_m2, 100.0, 1.0);
}

// A hall that the watershed parts askew between a pillar and a corner, no part of which is a room.
TEST(MergeClusters, OfAHallThatPillarsPartGiveItsRoom) {
  for (const double yaw : headings) {
    Scene hall{{{0, 0, 16, 9}}, {}, {}, yaw};
    hall.enclose({0, 0, 16, 9});
    const FreeGrid grid = hall.grid();
    std::vector<std::size_t> parts[2];
    for (std::size_t k = 0; k < grid.free.size(); ++k) {
      if (grid.free[k] == 0) continue;
      const Eigen::Vector2d p_M = grid.frame.center(k);
      const Eigen::Vector3d p = hall.X_MW().inverse() * Eigen::Vector3d(p_M.x(), p_M.y(), 0.0);
      parts[p.y() < 0.5 * p.x() ? 0 : 1].push_back(k);
    }
    const std::vector<Cluster> two = {cluster_of(grid, parts[0]), cluster_of(grid, parts[1])};
    const std::vector<RoomCandidate> rooms = detect_rooms(grid, two, hall.walls(), hall.at({{8, 3}}), {});
    ASSERT_EQ(rooms.size(), 1U) << yaw;
    EXPECT_EQ(rooms[0].kind, RoomKind::four_wall);
    EXPECT_NEAR(signed_area(rooms[0].polygon_M), 144.0, 1e-6);
  }
}

}  // namespace
}  // namespace plumbline::slam
