// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/straight_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/rooms/overlap.h"
#include "tests/slam/rooms/scene.h"

namespace plumbline::slam {
namespace {

TEST(StraightEdges, AreTheSidesOfFreeSpaceAtAnyHeading) {
  for (int k = 0; k < 16; ++k) {
    const double yaw = 0.1 * k;
    const Scene scene{{{0, 0, 8, 3}, {0, 0, 3, 7}}, {}, {}, yaw};
    const FreeGrid grid = scene.grid();
    const std::vector<Cluster> found = clusters(grid, {});
    ASSERT_EQ(found.size(), 1U);
    const RoomConfig config;
    const ClusterWalls cluster_walls = make_cluster_walls(grid, found[0], {}, config);
    const Eigen::Vector2d axis(std::cos(yaw), std::sin(yaw));
    const std::vector<FaceLine> edges = straight_edges(cluster_walls, axis);
    // Two sides each to the left and below, and those to the right and above at two depths.
    ASSERT_GE(edges.size(), 6U) << yaw;
    for (const auto& [at_W, inward_W, length] : {std::tuple{Eigen::Vector2d(4, 0), Eigen::Vector2d(0, 1), 8.0},
                                                 {{0, 3}, {1, 0}, 7.0},
                                                 {{3, 5}, {-1, 0}, 4.0},
                                                 {{5, 3}, {0, -1}, 5.0},
                                                 {{8, 1}, {-1, 0}, 3.0},
                                                 {{1, 7}, {0, -1}, 3.0}}) {
      const Eigen::Vector2d at = scene.to_M(at_W), m = scene.to_M(at_W + inward_W) - at;
      double nearest = 1e9;
      for (const FaceLine& edge : edges)
        if (edge.m.dot(m) > 0.99 && std::abs(edge.support - length) < 0.5)
          nearest = std::min(nearest, std::abs(edge.distance(at)));
      EXPECT_LT(nearest, 0.2) << "yaw " << yaw << " length " << length;  // two cells
    }
  }
}

// As where the robot only looks in: of four walls, two that meet are known as planes.
TEST(StraightEdges, StandForTheWallsOfARoomThatWasPartlySeen) {
  for (const double yaw : headings) {
    Scene scene{{{0, 0, 5, 4}}, {}, {}, yaw};
    scene.enclose({0, 0, 5, 4}, {1, 2});
    const std::vector<RoomCandidate> rooms = scene.rooms({{2, 2}});
    ASSERT_EQ(rooms.size(), 1U) << yaw;
    EXPECT_EQ(rooms[0].kind, RoomKind::polygon);
    EXPECT_EQ(rooms[0].planes, (std::vector<int>{1, 0}));
    EXPECT_EQ(rooms[0].corners.size(), 1U);
    Polygon2 whole;
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(0, 0), {5, 0}, {5, 4}, {0, 4}}) whole.push_back(scene.to_M(p));
    EXPECT_GT(overlap_area(rooms[0].polygon_M, whole), 18.5);  // a cell and a half at two sides of 20 m2
    EXPECT_LT(signed_area(rooms[0].polygon_M), 21.0);
  }
}

TEST(StraightEdges, DoNotMakeARoomOfAGarden) {
  // One wall, and free space that ends where rays do.
  Scene scene{{{0, 0, 6, 3}, {1, 2.9, 5, 5}, {2, 4.9, 4, 7}}, {}, {}, 0.3};
  scene.faces.push_back({{0, 0}, {6, 0}});
  EXPECT_TRUE(scene.rooms({{3, 1}}).empty());
}

}  // namespace
}  // namespace plumbline::slam
