// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/floor_layer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/graph/factors.h"
#include "slam/mapping/s_graphs_plus.h"
#include "slam/mapping/wall_layer.h"
#include "tests/slam/mapping/seen_planes.h"

namespace plumbline::slam {
namespace {

TEST(FloorLayer, ANewStoreyBeginsWhereTheFloorIsAnother) {
  const FloorLayerConfig config;
  const Pose ground = Pose::from_xyz_yaw({0, 0, 0.5}, 0), first = Pose::from_xyz_yaw({5, 0, 3.5}, 0);
  Graph graph;
  EXPECT_EQ(storey_of(graph, ground, std::vector{see_floor(ground, 0.0)}, config), 0);
  graph.keyframes.push_back({0, ground, ground, 0});
  graph.planes.push_back({Plane{Eigen::Vector3d::UnitZ(), 0.0}, PlaneKind::floor, 0, -1});
  EXPECT_EQ(storey_of(graph, ground, std::vector{see_floor(ground, 0.05)}, config), 0);
  EXPECT_EQ(storey_of(graph, first, std::vector{see_floor(first, 3.0)}, config), 1);
  graph.keyframes.push_back({1, first, first, 1});
  graph.planes.push_back({Plane{Eigen::Vector3d::UnitZ(), -3.0}, PlaneKind::floor, 1, -1});
  EXPECT_EQ(storey_of(graph, first, {}, config), 1) << "no floor seen: where it was";
  EXPECT_EQ(storey_of(graph, ground, std::vector{see_floor(ground, 0.0)}, config), 0) << "back down";
}

/// Storeys at 0 and 3 m.
Graph two_storeys() {
  Graph graph = at(Pose::from_xyz_yaw({0, 0, 0.5}, 0));
  graph.planes.push_back({Plane{Eigen::Vector3d::UnitZ(), 0.0}, PlaneKind::floor, 0, -1});
  graph.planes.push_back({Plane{Eigen::Vector3d::UnitZ(), -3.0}, PlaneKind::floor, 1, -1});
  return graph;
}

TEST(FloorLayer, ALandingBelongsToTheStoreyBelow) {
  Graph graph = two_storeys();
  for (const int former : {0, 1}) {
    graph.keyframes.back().storey = former;
    const Pose landing = Pose::from_xyz_yaw({2, 0, 2.0}, 0);
    EXPECT_EQ(storey_of(graph, landing, std::vector{see_floor(landing, 1.5)}, {}), 0);
  }
  graph.planes.pop_back();
  const Pose half_down = Pose::from_xyz_yaw({2, 0, -0.9}, 0), cellar = Pose::from_xyz_yaw({2, 0, -2.4}, 0);
  EXPECT_EQ(storey_of(graph, half_down, std::vector{see_floor(half_down, -1.4)}, {}), 0) << "nothing known below";
  EXPECT_EQ(storey_of(graph, cellar, std::vector{see_floor(cellar, -2.9)}, {}), 1);
}

TEST(FloorLayer, AFloorSeenFromAboveIsNotWhereTheRobotStands) {
  Graph graph = two_storeys();
  graph.keyframes.back().storey = 1;
  const Pose above = Pose::from_xyz_yaw({2, 0, 3.5}, 0);
  EXPECT_EQ(storey_of(graph, above, std::vector{see_floor(above, 0.0)}, {}), 1);
}

TEST(FloorLayer, FlightsOfStairsAreNoFloors) {
  const Pose X = Pose::from_xyz_yaw({2, 0, 0.5}, 0.7);
  PlaneObservation flight = see_floor(X, 0.0), ramp = flight;
  flight.plane_R.n = (X.q.conjugate() * Eigen::Vector3d(-0.5, 0.0, 0.8)).normalized();
  ramp.plane_R.n = X.q.conjugate() * Eigen::Vector3d(std::sin(0.05), 0.0, std::cos(0.05));
  std::vector<PlaneObservation> seen = {flight, see_floor(X, 0.0), ramp, see(X, {0, 0}, {4, 0})};
  drop_tilted_planes(seen, X, {});
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].plane_R.n, see_floor(X, 0.0).plane_R.n);
  EXPECT_TRUE(seen[2].vertical);
}

TEST(FloorLayer, CentreIsMidwayBetweenTheWidestPairsAndRoomsHangOnIt) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  Graph graph = at(X);
  WallLayerConfig config;
  config.min_observations = 1;
  WallLayer walls(config);
  // A storey of 10 x 6 m with a partition's two faces at x = 4 and 4.1.
  (void)walls.observe(graph,
                      std::vector{see(X, {0, 0}, {10, 0}), see(X, {10, 0}, {10, 6}), see(X, {10, 6}, {0, 6}),
                                  see(X, {0, 6}, {0, 0}), see(X, {4, 0}, {4, 6}), see(X, {4.1, 6}, {4.1, 0})},
                      0.0);
  graph.rooms.push_back({RoomKind::four_wall, {2.0, 3.0}, 0, true});
  graph.rooms.push_back({RoomKind::four_wall, {7.0, 3.0}, 0, false});
  FloorLayer floors({});
  floors.update(graph, 0, walls.walls(graph, 0));
  floors.update(graph, 0, walls.walls(graph, 0));
  ASSERT_EQ(graph.floors.size(), 1U);
  EXPECT_LT((graph.floors[0].center_M - Eigen::Vector2d(5, 3)).norm(), 1e-9);
  ASSERT_EQ(graph.floor_factors.size(), 1U) << "one factor a room that is found, however often it is updated";
  const FloorFactor& f = graph.floor_factors[0];
  EXPECT_LT(floor_residual(graph.floors[0].center_M, graph.rooms[0].center_M, f.offset_M).norm(), 1e-9);
}

// The centre is that of the widest pairs when it was taken; it is taken anew once they have moved by refresh_m (t_f).
TEST(FloorLayer, CentreIsTakenAnewBeyondTheThreshold) {
  const FloorLayerConfig config;
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  const auto centre_after = [&](double longer_m) {
    Graph graph = at(X);
    WallLayerConfig once;
    once.min_observations = 1;
    FloorLayer floors(config);
    for (const double length : {6.0, 6.0 + longer_m}) {
      WallLayer walls(once);
      graph.planes.clear();
      graph.plane_factors.clear();
      (void)walls.observe(graph,
                          std::vector{see(X, {0, 0}, {length, 0}), see(X, {length, 0}, {length, 4}),
                                      see(X, {length, 4}, {0, 4}), see(X, {0, 4}, {0, 0})},
                          0.0);
      floors.update(graph, 0, walls.walls(graph, 0));
    }
    EXPECT_EQ(graph.floors.size(), 1U);
    return graph.floors.at(0).center_M.x();
  };
  EXPECT_NEAR(centre_after(1.9 * config.refresh_m), 3.0, 1e-9);
  EXPECT_NEAR(centre_after(2.1 * config.refresh_m), 3.0 + 1.05 * config.refresh_m, 1e-9);
}

}  // namespace
}  // namespace plumbline::slam
