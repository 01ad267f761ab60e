// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/same_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "slam/graph/optimize.h"
#include "slam/mapping/floor_layer.h"
#include "slam/mapping/room_layer.h"
#include "slam/mapping/wall_layer.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

using Walls = std::vector<int>;
using Pairs = std::vector<SameWall>;

TEST(SameWalls, MatchesByIdFirstThenTheBestFit) {
  // Wall k + 10 is wall k seen again; 12 is not quite as near to 3 as 13 is.
  const WallDistance distance = [](int a, int b) { return b - 10 == a ? 0.1 : b == 12 && a == 3 ? 0.2 : 2.0; };
  EXPECT_EQ(same_walls(Walls{1, 2, 3, 4}, Walls{3, 4, 1, 2}, distance), Pairs{});
  EXPECT_EQ(same_walls(Walls{1, 2, 3, 4}, Walls{11, 2, 3, 4}, distance), (Pairs{{1, 11}}));
  EXPECT_EQ(same_walls(Walls{4, 3, 2, 1}, Walls{12, 13, 14, 1}, distance), (Pairs{{2, 12}, {3, 13}, {4, 14}}));
}

TEST(SameWalls, ARoomWithOneWallThatIsAnotherIsAnotherRoom) {
  const WallDistance distance = [](int a, int b) { return b - 10 == a && a != 4 ? 0.1 : 1.5; };
  EXPECT_FALSE(same_walls(Walls{1, 2, 3, 4}, Walls{11, 12, 13, 14}, distance).has_value());
  EXPECT_FALSE(same_walls(Walls{1, 2}, Walls{1, 2, 3, 4}, distance).has_value());
  EXPECT_FALSE(same_walls(Walls{1, 2}, Walls{11, 11}, distance).has_value()) << "one wall cannot be two";
}

/// A room seen on two visits with a way between them over which the belief drifts.
struct Visits {
  Graph graph;
  int known = 0;        ///< planes of the first visit
  double back_m = 0.0;  ///< error of the last keyframe
};

Visits visit_twice(const Pose& drift, const WallLayerConfig& config) {
  constexpr double way_m = 12.0;
  const synthetic::House house = synthetic::one_room();
  MotionBuffer still;
  still.add(Odometry{});
  WallLayer walls(config);
  RoomLayerConfig room_config;
  room_config.free_space.sensor_height_m = synthetic::calibration().sensor_height_m;
  RoomLayer rooms(room_config);
  const FloorLayerConfig levels;
  Visits visits;
  Graph& graph = visits.graph;
  double walked_m = 0.0;
  std::vector<Pose> truth;
  for (int k = 0; k < 20; ++k) {
    const double turn = 0.6 * k;
    truth.push_back(Pose::from_xyz_yaw({3.0 + 1.2 * std::cos(turn), 2.0 + 0.8 * std::sin(turn), 0.46}, turn + 1.0));
    const Pose X_OR = k < 10 ? truth.back() : drift * truth.back();
    Pose X_MR = X_OR;
    if (k > 0) {
      const Pose step = graph.keyframes.back().X_OR.inverse() * X_OR;
      X_MR = graph.keyframes.back().X_MR * step;
      const double sigma_m = k == 10 ? 0.4 : 0.006, sigma_rad = k == 10 ? 0.05 : 0.002;
      walked_m += k == 10 ? way_m : 0.6;
      Vector6d information;
      information << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
          Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
      graph.pose_factors.push_back({k - 1, k, step, information.asDiagonal(), false});
    }
    graph.keyframes.push_back({k, X_MR, X_OR, 0});
    const DeskewedScan scan =
        deskew(synthetic::standing_scan(house, truth.back(), {}), still, synthetic::calibration());
    std::vector<PlaneObservation> seen = detect_planes(scan, {});
    drop_tilted_planes(seen, X_MR, levels);
    walls.observe(graph, seen, walked_m);
    bool found = walls.find_duplicates(graph, 0);
    rooms.add_scan(graph, scan, seen);
    const std::vector<PlaneNode> known = walls.walls(graph, 0);
    const WallDistance distance = [&](int a, int b) { return walls.room_normalized_mahalanobis2(known, a, b); };
    found |= walls.add_duplicates(graph, known, rooms.find_revisited_walls(graph, walls.seen_now(graph), distance));
    rooms.update(graph, 0, known);
    if (k == 9) visits.known = static_cast<int>(graph.planes.size());
    if (!found) continue;
    optimize(graph, 1, {});
    walls.merge_duplicates(graph);
  }
  optimize(graph, 1, {});
  walls.merge_duplicates(graph);
  visits.back_m = (graph.keyframes.back().X_MR.t - truth.back().t).norm();
  return visits;
}

// 0.42 m off, a wall alone is another wall to the gate of one observation; all walls of the room agree.
TEST(SameWalls, ARoomSeenAgainBringsTheRobotBack) {
  WallLayerConfig without;
  without.room_offset_m = 0.0;
  for (const double yaw : {0.0, 0.01}) {
    const Pose drift = Pose::from_xyz_yaw({0.42, 0.0, 0.0}, yaw);
    const Visits lost = visit_twice(drift, without), back = visit_twice(drift, {});
    ASSERT_GT(lost.graph.planes.size(), static_cast<std::size_t>(lost.known)) << "nothing was planted";
    EXPECT_GT(lost.back_m, 0.2);
    EXPECT_LT(back.back_m, 0.03);
    int merged = 0;
    for (const PlaneVertex& plane : back.graph.planes) merged += plane.merged_into >= 0 ? 1 : 0;
    EXPECT_GE(merged, 2) << "both walls across the drift";
    EXPECT_EQ(std::count_if(back.graph.rooms.begin(), back.graph.rooms.end(), [](auto& r) { return r.found; }), 1);
  }
}

}  // namespace
}  // namespace plumbline::slam
