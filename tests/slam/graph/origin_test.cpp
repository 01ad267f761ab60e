// SPDX-License-Identifier: Apache-2.0
// Where the map's origin and axes lie is nobody's business: the graph of a house gives the same house from anywhere.
#include <gtest/gtest.h>

#include <numbers>

#include "slam/graph/factors.h"
#include "slam/graph/incremental.h"
#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

constexpr double same_m = 1e-3;                               // [issue: within 1 mm ...
constexpr double same_rad = 0.01 * std::numbers::pi / 180.0;  // ... and 0.01 degrees]

/// A 6 x 4 m room and, behind its wall, a corridor of 8 x 2 m, seen by a robot that walks through both with noise.
Graph house(std::uint64_t seed) {
  RandomValues random(seed, 0);
  const std::vector<Plane> planes = {{{1, 0, 0}, 0.0},  {{-1, 0, 0}, 6.0}, {{0, 1, 0}, 0.0}, {{0, -1, 0}, 4.0},
                                     {{0, 1, 0}, -4.2}, {{0, -1, 0}, 6.2}, {{0, 0, 1}, 0.5}};
  Graph graph;
  Pose X_WR_before;
  for (int k = 0; k < 24; ++k) {
    const bool in_room = k < 12;
    const double s = 0.4 * (in_room ? k : k - 12);
    const Pose X_WR = Pose::from_xyz_yaw({1.0 + s, in_room ? 2.0 : 5.2, 0.0}, 0.1 * k);
    const Pose step = k == 0 ? Pose{} : X_WR_before.inverse() * X_WR * random.pose(0.01, 0.003);
    const Pose X_MR = k == 0 ? X_WR : graph.keyframes.back().X_MR * step;
    if (k > 0) graph.pose_factors.push_back({k - 1, k, step, Matrix6d::Identity() * 1e4, false});
    graph.keyframes.push_back({k * 1'000'000'000LL, X_MR, X_MR, 0});
    for (int p = 0; p < 7; ++p) {
      if (p < 6 && (p < 4) != in_room) continue;
      const Plane seen = increment(X_WR.inverse() * planes[static_cast<std::size_t>(p)], random.vector(0.004));
      graph.plane_factors.push_back({k, p, seen, Eigen::Matrix3d::Identity() / (0.005 * 0.005)});
    }
    X_WR_before = X_WR;
  }
  for (int p = 0; p < 7; ++p)
    graph.planes.push_back({increment(planes[static_cast<std::size_t>(p)], random.vector(0.01)),
                            p < 6 ? PlaneKind::wall : PlaneKind::floor, 0, -1});
  graph.planes.push_back({increment(planes[3], random.vector(0.02)), PlaneKind::wall, 0, -1});
  graph.plane_factors.push_back({11, 7, X_WR_before.inverse() * planes[3], Eigen::Matrix3d::Identity() * 1e4});
  graph.plane_factors.back().plane_R = graph.keyframes[11].X_MR.inverse() * graph.planes[7].plane_M;
  graph.duplicate_factors.push_back({3, 7, {3.0, 4.0, 0.5}});
  graph.rooms = {
      {RoomKind::four_wall, {2.9, 2.1}, 0}, {RoomKind::two_wall, {3.1, 5.3}, 0}, {RoomKind::polygon, {3.0, 3.0}, 0}};
  const Eigen::Matrix2d weight = Eigen::Matrix2d::Identity() * 400.0;
  graph.room_factors = {{0, {0, 1, 2, 3}, {3.0, 2.0}, 0.1, weight},
                        {1, {4, 5}, {3.2, 5.1}, 0.1, weight},
                        {2, {0, 2, 1, 5}, {3.0, 3.0}, 0.1, weight, {{0, 1}, {1, 2}, {3, 2}}}};
  graph.floors = {{{3.0, 3.1}, 0, 6}};
  graph.floor_factors = {{0, 0, {0.1, 1.0}, Eigen::Matrix2d::Identity()},
                         {0, 1, {0.0, -2.0}, Eigen::Matrix2d::Identity()}};
  return graph;
}

Eigen::Vector2d moved(const Pose& X_NM, const Eigen::Vector2d& p_M) {
  return (X_NM * Eigen::Vector3d(p_M.x(), p_M.y(), 0.0)).head<2>();
}

/// The graph in another map frame N; X_NM turns about the vertical.
Graph moved(const Pose& X_NM, Graph graph) {
  const auto turned = [&](const Eigen::Vector2d& v) { return Eigen::Vector2d(moved(X_NM, v) - X_NM.t.head<2>()); };
  for (KeyframeVertex& k : graph.keyframes) k.X_MR = X_NM * k.X_MR;
  for (PlaneVertex& p : graph.planes) p.plane_M = X_NM * p.plane_M;
  for (RoomVertex& r : graph.rooms) r.center_M = moved(X_NM, r.center_M);
  for (FloorVertex& f : graph.floors) f.center_M = moved(X_NM, f.center_M);
  for (RoomFactor& f : graph.room_factors) {
    f.cluster_M = moved(X_NM, f.cluster_M);
    f.height_M += X_NM.t.z();
  }
  for (FloorFactor& f : graph.floor_factors) f.offset_M = turned(f.offset_M);
  for (DuplicateFactor& f : graph.duplicate_factors) f.anchor_M = X_NM * f.anchor_M;
  return graph;
}

void expect_same(const Graph& a, const Graph& b, const std::string& what) {
  for (std::size_t k = 0; k < a.keyframes.size(); ++k) {
    const Pose error = a.keyframes[k].X_MR.inverse() * b.keyframes[k].X_MR;
    EXPECT_LT(error.t.norm(), same_m) << what << ", keyframe " << k;
    EXPECT_LT(log_so3(error.q).norm(), same_rad) << what << ", keyframe " << k;
  }
  for (std::size_t r = 0; r < a.rooms.size(); ++r)
    EXPECT_LT((a.rooms[r].center_M - b.rooms[r].center_M).norm(), same_m) << what << ", room " << r;
  EXPECT_LT((a.floors[0].center_M - b.floors[0].center_M).norm(), same_m) << what;
}

/// Far from the origin a wall's tilt and offset go together and the way to the optimum is longer.
OptimizerConfig to_the_end() {
  OptimizerConfig config;
  config.max_iterations = 100;
  config.relative_decrease = 1e-10;
  return config;
}

struct Elsewhere {
  std::string name;
  Pose X_NM;
};

std::vector<Elsewhere> elsewhere() {
  const double turn = 37.0 * std::numbers::pi / 180.0;
  return {{"turned by 37 degrees", Pose::from_xyz_yaw({0, 0, 0}, turn)},
          {"1 km away", Pose::from_xyz_yaw({1000.0, -400.0, 0.0}, 0.0)},
          {"turned and 1 km away", Pose::from_xyz_yaw({600.0, 800.0, 20.0}, turn)},
          {"the room's centre is the origin", Pose::from_xyz_yaw({-3.0, -2.0, 0.0}, 0.0)},
          {"the corridor's middle is the origin", Pose::from_xyz_yaw({-3.2, -5.2, 0.0}, 0.0)},
          {"and turned", Pose::from_xyz_yaw({0, 0, 0}, turn) * Pose::from_xyz_yaw({-3.2, -5.2, 0.0}, 0.0)}};
}

TEST(Origin, TheWholeGraphGivesTheSameFromAnywhere) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Graph here = house(seed);
    optimize(here, 1, to_the_end());
    for (const auto& [name, X_NM] : elsewhere()) {
      Graph there = moved(X_NM, house(seed));
      optimize(there, 1, to_the_end());
      expect_same(here, moved(X_NM.inverse(), there), name);
    }
  }
}

TEST(Origin, TheWindowGivesTheSameFromAnywhere) {
  const auto solve = [](Graph graph) {
    IncrementalConfig config;
    config.window = 8;
    IncrementalOptimizer optimizer(config, to_the_end());
    optimizer.solve(graph, 1);
    optimizer.relinearize(graph);
    optimizer.update(graph);
    return graph;
  };
  const Graph here = solve(house(4));
  for (const auto& [name, X_NM] : elsewhere())
    expect_same(here, moved(X_NM.inverse(), solve(moved(X_NM, house(4)))), name);
}

}  // namespace
}  // namespace plumbline::slam
