// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/wall_cuts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/slam/rooms/scene.h"

namespace plumbline::slam {
namespace {

/// Clusters that the one cluster of a scene is cut into, by falling area; none where it stays one.
std::vector<double> areas_after_cut(const Scene& scene, const std::vector<Eigen::Vector2d>& visited_W) {
  const FreeGrid grid = scene.grid();
  const std::vector<Cluster> found = clusters(grid, {});
  EXPECT_EQ(found.size(), 1U);
  if (found.size() != 1) return {};
  std::vector<FaceLine> faces;
  for (const PlaneNode& wall : scene.walls()) faces.push_back(face_line(wall));
  const RoomConfig config;
  std::vector<double> areas;
  for (const Cluster& part :
       cut_along_walls(make_cluster_walls(grid, found[0], faces, config), faces, scene.at(visited_W)))
    areas.push_back(part.area_m2);
  std::sort(areas.rbegin(), areas.rend());
  return areas;
}

/// A living room of 11 x 4 m above a hall of 7 x 1.5 m, between which a wall of 0.2 m stands over all but `open_m`,
/// from the hall's right end.
Scene living_and_hall(double open_m, double yaw) {
  const double stub = 11.0 - open_m - 4.0;
  Scene scene{{{0, 1.7, 11, 5.7}, {4, 0, 11, 1.71}}, {{11.0 - stub, 1.5, 11, 1.7}}, {}, yaw};
  scene.faces = {
      {{4, 0}, {11, 0}},      {{11, 0}, {11, 1.5}},  {{11, 1.5}, {11 - stub, 1.5}}, {{11 - stub, 1.7}, {11, 1.7}},
      {{11, 1.7}, {11, 5.7}}, {{11, 5.7}, {0, 5.7}}, {{0, 5.7}, {0, 1.7}},          {{0, 1.7}, {4, 1.7}},
      {{4, 1.5}, {4, 0}}};
  return scene;
}

TEST(WallCuts, PartALivingRoomFromAHallBesideAWallThatStopsShort) {
  for (const double yaw : headings) {
    const std::vector<Eigen::Vector2d> both = {{5, 3.7}, {6, 0.7}};
    const std::vector<double> parts = areas_after_cut(living_and_hall(3.0, yaw), both);
    ASSERT_EQ(parts.size(), 2U) << yaw;
    EXPECT_NEAR(parts[0], 44.0, 2.0);  // a cell along the border of 30 m
    EXPECT_NEAR(parts[1], 10.5, 1.5);
    EXPECT_TRUE(areas_after_cut(living_and_hall(5.5, yaw), both).empty()) << yaw;  // 1.5 of 7 m is wall
    EXPECT_EQ(living_and_hall(3.0, yaw).rooms(both).size(), 2U) << yaw;
  }
}

TEST(WallCuts, LeaveTheArmsOfABentRoomAndAlcovesAlone) {
  for (const double yaw : headings) {
    Scene bent{{{0, 0, 9, 3}, {0, 0, 3.5, 8}}, {}, {}, yaw};
    bent.faces = {{{0, 0}, {9, 0}},     {{9, 0}, {9, 3}},   {{9, 3}, {3.5, 3}},
                  {{3.5, 3}, {3.5, 8}}, {{3.5, 8}, {0, 8}}, {{0, 8}, {0, 0}}};
    EXPECT_TRUE(areas_after_cut(bent, {{8, 1}, {1, 7}}).empty()) << yaw;
    Scene alcove{{{0, 0, 9, 4}, {3, 3.9, 6.5, 6}}, {}, {}, yaw};
    alcove.faces = {{{0, 0}, {9, 0}},   {{9, 0}, {9, 4}}, {{9, 4}, {6.5, 4}}, {{6.5, 4}, {6.5, 6}},
                    {{6.5, 6}, {3, 6}}, {{3, 6}, {3, 4}}, {{3, 4}, {0, 4}},   {{0, 4}, {0, 0}}};
    EXPECT_TRUE(areas_after_cut(alcove, {{8, 1}, {5, 5}}).empty()) << yaw;
  }
}

/// A room of 6 x 4 m whose far side is of glass: 1 m of wall at one end, then a frame that rays pass, to a garden.
Scene glass_front(double yaw) {
  Scene scene{{{0, 0, 6, 4}, {1, 3.9, 6, 12}}, {}, {}, yaw};
  scene.enclose({0, 0, 6, 4}, {2});
  scene.faces.push_back({{1, 4}, {0, 4}});
  scene.faces.push_back({{5.5, 4.1}, {1.2, 4.1}});
  return scene;
}

TEST(WallCuts, EndARoomAtAGlassFrontThatTheRobotDidNotPass) {
  for (const double yaw : headings) {
    const std::vector<double> parts = areas_after_cut(glass_front(yaw), {{3, 2}});
    ASSERT_EQ(parts.size(), 2U) << yaw;
    EXPECT_NEAR(std::min(parts[0], parts[1]), 24.0, 1.5);
    const std::vector<RoomCandidate> rooms = glass_front(yaw).rooms({{3, 2}});
    ASSERT_EQ(rooms.size(), 1U) << yaw;
    EXPECT_NEAR(signed_area(rooms[0].polygon_M), 24.0, 1.0);
  }
}

// As of a flight of stairs: a plane of which rays pass over most.
TEST(WallCuts, DoNotPartARoomThatWasEnteredOnBothSidesOfWhatScansPassOver) {
  for (const double yaw : headings) {
    Scene scene{{{0, 0, 6, 5}}, {}, {}, yaw};
    scene.enclose({0, 0, 6, 5});
    scene.faces.push_back({{1.5, 2.5}, {6, 2.5}});
    EXPECT_TRUE(areas_after_cut(scene, {{1, 1}, {1, 4}}).empty()) << yaw;
  }
}

}  // namespace
}  // namespace plumbline::slam
