// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "slam/graph/factors.h"
#include "slam/mapping/room_layer.h"
#include "slam/mapping/s_graphs_plus.h"
#include "slam/mapping/wall_layer.h"
#include "slam/scan/motion.h"
#include "tests/slam/graph/random_values.h"
#include "tests/slam/mapping/seen_planes.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// The next keyframe, which sees `seen`; returns the plane ids.
std::vector<int> step(Graph& graph, WallLayer& walls, const Pose& X_MR, const std::vector<PlaneObservation>& seen) {
  const int storey = graph.keyframes.back().storey;
  graph.keyframes.push_back({graph.keyframes.back().stamp + 1, X_MR, X_MR, storey});
  return walls.observe(graph, seen, 1.0);
}

TEST(WallLayer, KnowsAWallAgainFromAnyPoseAndWithinTheDrift) {
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    RandomValues random(1, trial);
    const double yaw = random.uniform(-3.0, 3.0);
    const Pose X_MW = Pose::from_xyz_yaw(random.vector(10.0), yaw);
    const auto in_M = [&](double x, double y) { return Eigen::Vector2d((X_MW * Eigen::Vector3d(x, y, 0)).head<2>()); };
    const auto pose = [&](double x, double y, double a) { return X_MW * Pose::from_xyz_yaw({x, y, 0}, a); };
    Graph graph = at(pose(1.0, 2.0, 0.3));
    WallLayer walls({});
    const std::vector<int> first = walls.observe(graph, std::vector{see(pose(1, 2, 0.3), in_M(0, 0), in_M(4, 0))}, 0);
    // Truth and belief of the second pose differ by less than one sigma of the drift.
    const Pose truth = pose(3.0, 1.5, -1.0);
    const Pose belief = truth * Pose::from_xyz_yaw({0.015, 0.015, 0.0}, 0.003);
    const std::vector<int> second = step(graph, walls, belief, {see(truth, in_M(2, 0), in_M(6, 0))});
    EXPECT_EQ(first, second);
    const PlaneNode node = walls.extents(graph).at(0);
    EXPECT_EQ(node.observations, 2);
    EXPECT_NEAR((node.p1 - node.p0).norm(), 6.0, 0.05);
  }
}

TEST(WallLayer, KeepsApartWhatIsNotOneFace) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  const Eigen::Vector2d a(0, 0), b(4, 0);
  const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> others = {
      {{0, 0.4}, {4, 0.4}},      // parallel, 0.4 m in front
      {{4, -0.15}, {0, -0.15}},  // the other side of the wall
      {{7, 0}, {9, 0}},          // coplanar, but 3 m of nothing in between
      {{0, 0}, {4, 0.6}}};       // turned by 8.5 degrees
  for (const auto& [c, d] : others) {
    Graph graph = at(X);
    WallLayer walls({});
    (void)walls.observe(graph, std::vector{see(X, a, b)}, 0.0);
    EXPECT_EQ(step(graph, walls, X, {see(X, c, d)}), std::vector<int>{1});
  }
}

// Storeys with the same walls: what is seen upstairs is another wall and no duplicate, though the belief's height had
// drifted down to the storey below.
TEST(WallLayer, StoreysThatLookAlikeShareNoWall) {
  const Pose X_MR = Pose::from_xyz_yaw({1.0, 2.0, 0.0}, 0.3);
  Graph graph = at(X_MR);
  WallLayer walls({});
  const std::vector<PlaneObservation> seen = {see(X_MR, {0, 0}, {4, 0}), see(X_MR, {4, 5}, {0, 5})};
  const std::vector<int> below = walls.observe(graph, seen, 0);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(step(graph, walls, X_MR, seen), below);
  graph.keyframes.back().storey = 1;
  const std::vector<int> above = step(graph, walls, X_MR, seen);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(step(graph, walls, X_MR, seen), above);
  for (const int id : above) EXPECT_EQ(std::count(below.begin(), below.end(), id), 0) << id;
  EXPECT_FALSE(walls.find_duplicates(graph, 0));
  EXPECT_FALSE(walls.find_duplicates(graph, 1));
  EXPECT_EQ(walls.walls(graph, 0).size(), 2U);
  EXPECT_EQ(walls.walls(graph, 1).size(), 2U);
}

// Upstairs, before that is known: the wall there stands a little aside, and would tilt the one below.
TEST(WallLayer, AWallAboveIsAnotherOneUnlessItGoesOnUp) {
  for (const double z : {0.8, 2.9}) {
    const Pose below = Pose::from_xyz_yaw({2, 2, 0}, 0), above = Pose::from_xyz_yaw({2, 2, z}, 0);
    Graph graph = at(below);
    WallLayer walls({});
    (void)walls.observe(graph, std::vector{see(below, {0, 0}, {4, 0})}, 0.0);
    EXPECT_EQ(step(graph, walls, above, {see(above, {0, 0.02}, {4, 0.02})}), std::vector<int>{z < 1.9 ? 0 : 1}) << z;
  }
}

TEST(WallLayer, ReportsHighWallsThatWereSeenOften) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0.5}, 0);
  Graph graph = at(X);
  WallLayer walls({});
  PlaneObservation counter = see(X, {3, 3}, {1, 3});
  counter.z1 = 0.4;
  const std::vector<PlaneObservation> seen = {see(X, {0, 0}, {4, 0}), counter, see_floor(X, 0.0)};
  (void)walls.observe(graph, seen, 0.0);
  EXPECT_TRUE(walls.walls(graph, 0).empty());
  for (int k = 1; k < WallLayerConfig{}.min_observations; ++k) (void)step(graph, walls, X, seen);
  const std::vector<PlaneNode> known = walls.walls(graph, 0);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].id, 0);
  EXPECT_TRUE(walls.walls(graph, 1).empty());
}

TEST(WallLayer, PullsDuplicatesTogetherAndMergesThem) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  WallLayerConfig config;
  config.gate_chi2 = 0.0;  // no association: every observation makes a vertex
  config.min_observations = 1;
  Graph graph = at(X);
  WallLayer walls(config);
  (void)walls.observe(graph, std::vector{see(X, {0, 0}, {4, 0}), see(X, {1, 0.05}, {3, 0.05})}, 0.0);
  EXPECT_TRUE(walls.find_duplicates(graph, 0));
  EXPECT_FALSE(walls.find_duplicates(graph, 0)) << "a pair was found twice";
  ASSERT_EQ(graph.duplicate_factors.size(), 1U);
  EXPECT_EQ(walls.merge_duplicates(graph), 1);
  EXPECT_EQ(graph.planes[1].merged_into, 0);
  for (const PlaneFactor& f : graph.plane_factors) EXPECT_EQ(f.plane, 0);
  EXPECT_EQ(walls.walls(graph, 0).size(), 1U);
  EXPECT_TRUE(graph.duplicate_factors.empty());
}

// Two stretches of one wall, of which the second is seen again 20 m on: the wall has been seen just now, and what
// stands 0.2 m before it is no drift.
TEST(WallLayer, AMergedWallWasSeenWhenEitherWas) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  const PlaneObservation left = see(X, {0, 0}, {1, 0}), right = see(X, {3, 0}, {4, 0});
  const PlaneObservation before = see(X, {1, 0.2}, {3, 0.2});
  Graph graph = at(X);
  WallLayer walls({});
  EXPECT_EQ(walls.observe(graph, std::vector{left, right}, 0.0), (std::vector<int>{0, 1}));
  graph.keyframes.push_back({1, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{right}, 20.0), std::vector<int>{1});
  graph.duplicate_factors.push_back({0, 1, {2, 0, 0}, 0.01, 0.02});
  EXPECT_EQ(walls.merge_duplicates(graph), 1);
  graph.keyframes.push_back({2, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{before}, 20.0), std::vector<int>{2});
  graph.keyframes.push_back({3, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{left}, 20.0), std::vector<int>{0}) << "the wall itself is known";
}

TEST(RoomLayer, OfOneKeyframeFollowsItsWallsAndTheGraph) {
  Graph graph = at(Pose::from_xyz_yaw({2, 1.5, 0}, 0));
  const std::array<PlaneNode, 4> seen = {{{0, Plane{{1, 0, 0}, 0}, {0, 0}, {0, 3}, 0.0, 2.4, 1},
                                          {4, Plane{{-1, 0, 0}, 4}, {4, 0}, {4, 3}, 0.0, 2.4, 1},
                                          {2, Plane{{0, 1, 0}, 0}, {0, 0}, {4, 0}, 0.0, 2.4, 1},
                                          {3, Plane{{0, -1, 0}, 3}, {0, 3}, {4, 3}, 0.0, 2.4, 1}}};
  for (const std::size_t k : {0U, 1U, 2U, 3U, 1U}) graph.planes.push_back({seen[k].plane_F, PlaneKind::wall, 0, -1});
  RoomLayerConfig config;
  config.source = RoomSource::keyframe;
  RoomLayer rooms(config);
  rooms.add_from_keyframe(graph, seen);
  ASSERT_EQ(graph.room_factors.size(), 1U);
  ASSERT_EQ(graph.room_factors[0].planes, (std::vector<int>{0, 4, 2, 3}));
  graph.planes[4].merged_into = 1;
  rooms.redirect_merged_planes(graph);
  EXPECT_EQ(graph.room_factors[0].planes, (std::vector<int>{0, 1, 2, 3}));
  graph.rooms[0].center_M += Eigen::Vector2d(0.3, -0.2);
  const std::vector<RoomNode> nodes = rooms.nodes(graph);
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].planes, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_EQ(nodes[0].polygon_F.size(), 4U);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : nodes[0].polygon_F) mean += 0.25 * p;
  EXPECT_LT((mean - Eigen::Vector2d(2.3, 1.3)).norm(), 1e-12);
  EXPECT_NEAR(std::abs(signed_area(nodes[0].polygon_F)), 12.0, 1e-9);
}

// A wall of a storey that the robot has left may become one with another later on.
TEST(RoomLayer, OfFreeSpaceFollowsMergedWalls) {
  Graph graph = at(Pose());
  graph.planes.resize(5);
  graph.rooms.resize(2);
  graph.room_factors.push_back({.room = 0, .planes = {0, 4, 2, 3}, .corners = {{0, 2}, {2, 1}, {1, 3}, {3, 0}}});
  graph.room_factors.push_back({.room = 1, .planes = {1, 4}});
  graph.planes[4].merged_into = 1;
  RoomLayer rooms({});
  rooms.redirect_merged_planes(graph);
  ASSERT_EQ(graph.room_factors.size(), 1U) << "a room of one wall is none";
  EXPECT_EQ(graph.room_factors[0].planes, (std::vector<int>{0, 1, 2, 3}));
}

// As printed: free space is cut into clusters, the planes are of the newest keyframe, each look adds a factor.
TEST(RoomLayer, AsPrintedEachLookAddsAFactor) {
  Graph graph = at(Pose::from_xyz_yaw({2, 1.5, 0.46}, 0));
  const std::vector<PlaneNode> seen = {{0, Plane{{1, 0, 0}, 0}, {0, 0}, {0, 3}, 0.0, 2.4, 1},
                                       {1, Plane{{-1, 0, 0}, 4}, {4, 0}, {4, 3}, 0.0, 2.4, 1},
                                       {2, Plane{{0, 1, 0}, 0}, {0, 0}, {4, 0}, 0.0, 2.4, 1},
                                       {3, Plane{{0, -1, 0}, 3}, {0, 3}, {4, 3}, 0.0, 2.4, 1}};
  for (const PlaneNode& wall : seen) graph.planes.push_back({wall.plane_F, PlaneKind::wall, 0, -1});
  RoomLayerConfig config = SGraphsPlusPrintedConfig().rooms;
  config.free_space.sensor_height_m = synthetic::calibration().sensor_height_m;
  RoomLayer rooms(config);
  const Scan raw = synthetic::standing_scan(synthetic::one_room(4.0, 3.0), graph.keyframes[0].X_MR, {});
  MotionBuffer still;
  still.add({0, Pose()});
  const DeskewedScan scan = deskew(raw, still, synthetic::calibration());
  for (std::size_t look = 1; look <= 2; ++look) {
    if (look > 1) graph.keyframes.push_back({1, graph.keyframes[0].X_MR, Pose(), 0});
    rooms.add_scan(graph, scan, {});
    rooms.add_from_keyframe(graph, seen);
    ASSERT_EQ(graph.rooms.size(), 1U);
    EXPECT_EQ(graph.rooms[0].kind, RoomKind::four_wall);
    EXPECT_EQ(graph.room_factors.size(), look);
  }
  // With two of its walls in sight it is not known anew, and stays what it was.
  rooms.add_from_keyframe(graph, std::span(seen).first(2));
  EXPECT_EQ(graph.rooms.size(), 1U);
  EXPECT_EQ(graph.rooms[0].kind, RoomKind::four_wall);
}

// 0.3 m apart, first seen 30 m of way after each other: drift, until one scan shows both.
TEST(WallLayer, WallsOfARoomSeenAgainAreOneUnlessAScanShowsBoth) {
  const Pose X = Pose::from_xyz_yaw({2, 2, 0}, 0);
  WallLayerConfig config;
  config.gate_chi2 = 1.0;
  config.min_observations = 1;
  Graph graph = at(X);
  WallLayer walls(config);
  PlaneObservation back = see(X, {0, 0}, {4, 0}), front = see(X, {0, 0.3}, {4, 0.3}), beside = see(X, {6, 0}, {9, 0});
  for (PlaneObservation* o : {&back, &front, &beside}) o->centroid_R = 0.5 * (o->p0_R + o->p1_R);
  EXPECT_EQ(walls.observe(graph, std::vector{back}, 0.0), std::vector<int>{0});
  graph.keyframes.push_back({1, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{front}, 30.0), std::vector<int>{1});
  EXPECT_LT(walls.room_normalized_mahalanobis2(walls.walls(graph, 0), 0, 1), 1.0);
  EXPECT_EQ(walls.room_normalized_mahalanobis2(walls.walls(graph, 0), 0, 1),
            walls.room_normalized_mahalanobis2(walls.walls(graph, 0), 1, 0));
  graph.keyframes.push_back({2, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{beside}, 60.0), std::vector<int>{2});
  EXPECT_GT(walls.room_normalized_mahalanobis2(walls.walls(graph, 0), 0, 2), 1.0)
      << "in line, but not the same stretch";
  graph.keyframes.push_back({3, X, X, 0});
  EXPECT_EQ(walls.observe(graph, std::vector{back, front}, 60.1), (std::vector<int>{0, 1}));
  EXPECT_GT(walls.room_normalized_mahalanobis2(walls.walls(graph, 0), 0, 1), 1.0);
}

TEST(WallLayer, WallsOfOneOutlineOnTwoStoreysAreTwoWalls) {
  const Pose low = Pose::from_xyz_yaw({2, 2, 0.5}, 0), high = Pose::from_xyz_yaw({2, 2, 3.5}, 0);
  Graph graph = at(low);
  WallLayer walls({});
  const std::vector<int> first = walls.observe(graph, std::vector{see(low, {0, 0}, {4, 0})}, 0.0);
  graph.keyframes.push_back({1, high, high, 1});
  const std::vector<int> second = walls.observe(graph, std::vector{see(high, {0, 0}, {4, 0})}, 6.0);
  EXPECT_NE(first, second);
  EXPECT_FALSE(walls.find_duplicates(graph, 0));
  EXPECT_FALSE(walls.find_duplicates(graph, 1));
}

// A leaf 8 cm back in its wall is within the drift of it, but one scan shows both.
TEST(WallLayer, ALeafIsNeverItsWall) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    RandomValues random(32, trial);
    const Pose start = Pose::from_xyz_yaw({1.0, 2.0, 0.0}, random.uniform(-3.0, 3.0));
    const auto look = [&](const Pose& X_WR) {
      std::vector<PlaneObservation> seen = {see(X_WR, {0, 0}, {4, 0}), see(X_WR, {4, -0.08}, {4.9, -0.08})};
      for (PlaneObservation& o : seen) o.centroid_R = 0.5 * (o.p0_R + o.p1_R);
      if (trial % 2 == 1) std::swap(seen[0], seen[1]);
      return seen;
    };
    Graph graph = at(start);
    WallLayer walls({});
    const std::vector<int> first = walls.observe(graph, look(start), 0.0);
    EXPECT_NE(first[0], first[1]);
    for (int k = 0; k < 6; ++k) {
      const Pose truth = Pose::from_xyz_yaw({1.0 + 0.5 * k, 2.0, 0.0}, random.uniform(-3.0, 3.0));
      const Pose belief = Pose::from_xyz_yaw({0.0, 0.012 * random.gauss(), 0.0}, 0.0) * truth;
      EXPECT_EQ(step(graph, walls, belief, look(truth)), first) << "trial " << trial;
    }
    EXPECT_FALSE(walls.find_duplicates(graph, 0));
  }
}

// A pane above a sill that stands 9 cm before it. The strip's tilt, known within 0.2 rad, leaves its plane open by 9 cm
// at the pane's middle; the pane's own plane is known at the strip's.
TEST(WallLayer, APaneIsNotTheFaceOfTheSillBelowIt) {
  const Pose X = Pose::from_xyz_yaw({1.0, 2.0, 0.5}, 0.0);
  std::vector<PlaneObservation> seen = {see(X, {0.4, 0}, {1.7, 0}), see(X, {0, 0.09}, {2.1, 0.09})};
  const std::array<double, 2> heights_m = {0.2, -0.45}, tilts_rad = {0.018, 0.2};
  for (std::size_t k = 0; k < seen.size(); ++k) {
    PlaneObservation& o = seen[k];
    o.centroid_R = 0.5 * (o.p0_R + o.p1_R);
    o.centroid_R.z() = heights_m[k];
    const double v = plane_tangents(o.plane_R.n).v.dot(o.centroid_R), tilt2 = tilts_rad[k] * tilts_rad[k];
    const double sigma_m = 0.012;  // at the centroid
    o.covariance << 1e-5, 0.0, 0.0, 0.0, tilt2, -tilt2 * v, 0.0, -tilt2 * v, tilt2 * v * v + sigma_m * sigma_m;
  }
  for (int order = 0; order < 2; ++order) {
    Graph graph = at(X);
    WallLayer walls({});
    (void)walls.observe(graph, std::vector{seen[0]}, 0.0);
    const std::vector<int> both = step(graph, walls, X, seen);
    EXPECT_NE(both[0], both[1]) << order;
    std::swap(seen[0], seen[1]);
  }
}

TEST(WallLayer, FrozenObservationsKeepTheirExtent) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    RandomValues random(31, trial);
    const double yaw = random.uniform(-3.0, 3.0);
    const auto pose = [&](double x) {
      return Pose::from_xyz_yaw({0, 0, 0}, yaw) * Pose::from_xyz_yaw({x, random.uniform(1, 3), 0}, random.gauss());
    };
    const auto in_M = [&](double x, double y) {
      return Eigen::Vector2d((Pose::from_xyz_yaw({0, 0, 0}, yaw) * Eigen::Vector3d(x, y, 0)).head<2>());
    };
    const auto look = [&](const Pose& X_MR, double x) {
      return std::vector{see(X_MR, in_M(x - 1, 0), in_M(x + random.uniform(0.5, 2), 0)),
                         see(X_MR, in_M(x + 2, 5), in_M(x - random.uniform(0, 2), 5))};
    };
    Graph graph = at(pose(0.0));
    WallLayer walls({});
    walls.observe(graph, look(graph.keyframes[0].X_MR, 0.0), 0.0);
    for (int k = 1; k < 12; ++k) {
      const Pose X_MR = pose(k);
      step(graph, walls, X_MR, look(X_MR, k));
      const std::vector<PlaneNode> whole = walls.extents(graph);
      walls.freeze_extents(graph, k - 4);
      const std::vector<PlaneNode> summed = walls.extents(graph);
      ASSERT_EQ(summed.size(), whole.size());
      for (std::size_t id = 0; id < whole.size(); ++id) {
        EXPECT_EQ(summed[id].observations, whole[id].observations);
        EXPECT_LT((summed[id].p0 - whole[id].p0).norm() + (summed[id].p1 - whole[id].p1).norm(), 1e-9);
        EXPECT_EQ(summed[id].z0, whole[id].z0);
        EXPECT_EQ(summed[id].z1, whole[id].z1);
      }
      if (k == 6) walls.unfreeze_extents();
    }
  }
}

}  // namespace
}  // namespace plumbline::slam
