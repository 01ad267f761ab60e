// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/s_graphs_plus.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <vector>

#include "bim/digest/digest.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct Walked {
  std::vector<Eigen::Vector3d> truth, legs, causal, last;
  std::vector<std::vector<std::string>> stages, timed;  ///< of each scan, their names
  Estimate estimate;
  Graph graph;
  std::uint64_t digest = 0;
};

Walked run(const synthetic::Recording& recording, const SGraphsPlusConfig& config = {}, bool has_odometry = true) {
  MethodInput input;
  input.has_odometry = has_odometry;
  input.calibration = recording.calibration;
  SGraphsPlus method(input, config);
  Walked run;
  Digest digest;
  MotionBuffer legs;
  std::size_t next = 0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= recording.scans[k].stamp; ++next) {
      method.on_odometry(recording.odometry[next]);
      legs.add(recording.odometry[next]);
    }
    const Output output = method.on_scan(recording.scans[k]);
    run.stages.emplace_back();
    run.timed.emplace_back();
    for (const StageDigest& d : output.digests) {
      digest.add(d.stage).add(d.digest);
      run.stages.back().push_back(d.stage);
    }
    for (const StageTime& t : output.times) run.timed.back().push_back(t.stage);
    run.causal.push_back(output.X_FR->t);
    run.truth.push_back(recording.truth[k].X_FR.t);
    if (has_odometry) run.legs.push_back(legs.at(recording.scans[k].stamp).t);
  }
  run.estimate = method.finish();
  for (const StampedPose& pose : run.estimate.trajectory) run.last.push_back(pose.X_FR.t);
  run.graph = method.graph();
  run.digest = digest.add(digest_of(run.graph)).value();
  return run;
}

/// ATE after the best rigid motion, m.
double ate(const std::vector<Eigen::Vector3d>& estimate, const std::vector<Eigen::Vector3d>& truth) {
  Eigen::Matrix3Xd a(3, estimate.size()), b(3, truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    a.col(static_cast<Eigen::Index>(k)) = estimate[k];
    b.col(static_cast<Eigen::Index>(k)) = truth[k];
  }
  const Eigen::Matrix4d T = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd e = (T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>() - b;
  return std::sqrt(e.colwise().squaredNorm().mean());
}

const Walked& corridor_run() {
  static const Walked result = [] {
    synthetic::WalkConfig walk;
    walk.duration_s = 22.0;
    walk.range_bias_m = 0.015;
    walk.odometry_scale = 1.02;
    return run(synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk));
  }();
  return result;
}

TEST(SGraphsPlus, MoreThanHalvesAPlantedOdometryScale) {
  const Walked& r = corridor_run();
  EXPECT_LT(ate(r.causal, r.truth), 0.5 * ate(r.legs, r.truth));
  // Measured over 5 seeds of the whole walk: 0.010-0.016 m.
  EXPECT_LT(ate(r.causal, r.truth), 0.03);
  EXPECT_LT(ate(r.last, r.truth), 0.03);
}

TEST(SGraphsPlus, AnswersForEveryScanAndNamesItsStages) {
  const Walked& r = corridor_run();
  EXPECT_EQ(r.estimate.trajectory.size(), r.truth.size());
  EXPECT_EQ(r.estimate.frame, Frame::map);
  EXPECT_EQ(r.estimate.floors.size(), 1U);
  EXPECT_FALSE(r.estimate.map_F.empty());
  using Names = std::vector<std::string>;
  const Names each = {"deskew", "odometry"};
  const Names keyframe = {"deskew", "odometry", "planes", "association", "rooms", "floors", "loop", "graph"};
  std::size_t keyframes = 0;
  ASSERT_EQ(r.stages.size(), r.truth.size());
  for (std::size_t k = 0; k < r.stages.size(); ++k) {
    const bool whole = r.stages[k] == keyframe;
    keyframes += whole ? 1 : 0;
    EXPECT_TRUE(whole || r.stages[k] == each) << "scan " << k;
    EXPECT_EQ(r.timed[k], whole ? Names({"deskew", "odometry", "plane_segmentation", "association", "room_segmentation",
                                         "floor_segmentation", "loop_closure", "back_end", "map"})
                                : Names({"deskew", "odometry", "map"}));
  }
  EXPECT_EQ(r.stages.front(), keyframe);
  EXPECT_EQ(keyframes, r.graph.keyframes.size());
  EXPECT_GE(r.estimate.planes.size(), 4U) << "a room's";
  for (const PlaneNode& plane : r.estimate.planes) {
    EXPECT_GE(plane.observations, WallLayerConfig{}.min_observations);
    EXPECT_LT(std::abs(plane.plane_F.n.z()), 0.05);
  }
}

/// Somebody stands before the LiDAR when the recording begins: the first keyframe has no planes, and the way from it is
/// not known. The map must not turn about it.
TEST(SGraphsPlus, ACoveredStartHoldsTheMap) {
  synthetic::WalkConfig walk;
  walk.duration_s = 8.0;
  synthetic::Recording recording = synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  for (std::size_t k = 0; k < 15; ++k)
    std::fill(recording.scans[k].range_m.begin(), recording.scans[k].range_m.end(), 0.0);
  const Walked r = run(recording, {}, false);
  ASSERT_GT(r.graph.keyframes.size(), 2U);
  const PoseFactor& first = r.graph.pose_factors.front();
  EXPECT_GT(first.information(3, 3), 1e4);
  // How the map lies about the first keyframe is what dead reckoning said: it does not change with the graph.
  const Pose step = r.graph.keyframes[0].X_MR.inverse() * r.graph.keyframes[1].X_MR;
  EXPECT_LT(log_so3((first.X_FT.inverse() * step).q).norm(), 0.01);
}

TEST(SGraphsPlus, SurvivesTheMapsOriginAtARoomsCentre) {
  synthetic::WalkConfig walk;
  walk.duration_s = 6.0;
  walk.vibration = 0.0;
  const std::vector<Eigen::Vector2d> way = {{2.94, 2.0}, {4.5, 2.0}, {4.5, 3.0}, {2.0, 3.0}};
  const Walked r = run(synthetic::walk(synthetic::one_room(), way, walk));
  EXPECT_LT(ate(r.causal, r.truth), 0.02);
  ASSERT_EQ(r.estimate.rooms.size(), 1U);
  EXPECT_EQ(r.estimate.rooms[0].kind, RoomKind::four_wall);
  // M is where the first scan ended, 0.06 m on. Bounds: a fraction of a free-space cell, and the range noise.
  const Eigen::Vector2d center_M = Eigen::Vector2d(3.0, 2.0) - r.truth[0].head<2>();
  EXPECT_LT(center_M.norm(), 0.02);
  EXPECT_LT((r.estimate.rooms[0].center_F - center_M).norm(), 0.02);
  EXPECT_NEAR(std::abs(signed_area(r.estimate.rooms[0].polygon_F)), 24.0, 0.5);
}

TEST(SGraphsPlus, KeepsFewerScansForItsMapWhereTheyHoldTooManyPoints) {
  synthetic::WalkConfig walk;
  walk.duration_s = 8.0;
  const std::vector<Eigen::Vector2d> way = {{1.0, 1.0}, {5.0, 1.0}, {5.0, 3.0}, {1.0, 3.0}};
  const synthetic::Recording recording = synthetic::walk(synthetic::one_room(), way, walk);
  SGraphsPlusConfig few;
  few.map_points = 100'000;  // of some 20 to 30 scans of 10,000 and more
  const std::size_t all = run(recording).estimate.map_F.size(), kept = run(recording, few).estimate.map_F.size();
  EXPECT_LT(kept, all);
  EXPECT_GT(kept, all / 2);
}

// Two scans behind glass, say. What follows is matched with the map of before: nothing about the way is unknown.
TEST(SGraphsPlus, ScansThatDoNotFitLeaveTheWayToTheNextKeyframeMeasured) {
  synthetic::WalkConfig walk;
  walk.duration_s = 6.0;
  const std::vector<Eigen::Vector2d> way = {{1.0, 1.0}, {5.0, 1.0}, {5.0, 3.0}, {2.0, 3.0}};
  synthetic::Recording recording = synthetic::walk(synthetic::corridor_house(), way, walk);
  recording.odometry.clear();
  constexpr std::size_t first = 30, bad = 2;
  const Nanoseconds from = recording.scans[first].stamp;
  for (std::size_t k = first; k < first + bad; ++k)
    for (std::size_t i = 0; i < recording.scans[k].size(); ++i) {
      const double share = 0.3 + 0.4 * static_cast<double>(i * 7 % 11) / 11.0;
      recording.scans[k].range_m[i] *= share;
      recording.scans[k].point_L[i] *= share;
    }
  SGraphsPlusConfig config;
  config.odometry.vgicp.odometry_prior = config.odometry.vgicp.tilt_prior = false;
  const Walked r = run(recording, config, false);
  const auto over = std::find_if(r.graph.pose_factors.begin(), r.graph.pose_factors.end(), [&](const PoseFactor& f) {
    return r.graph.keyframes[static_cast<std::size_t>(f.to)].stamp >= from;
  });
  ASSERT_NE(over, r.graph.pose_factors.end());
  const Vector6d sigma = over->information.inverse().diagonal().cwiseSqrt();
  EXPECT_LT(sigma.head<3>().maxCoeff(), 0.02);  // measured: 0.009; as if unmeasured: 0.82
  EXPECT_LT(sigma.tail<3>().maxCoeff(), 0.02);
  EXPECT_LT(ate(r.causal, r.truth), 0.03);
}

// As printed: RANSAC planes, association by angles, constant weights; rooms from free space or from one keyframe.
TEST(PrintedMethods, WalkThroughARoomAndFindIt) {
  synthetic::WalkConfig walk;
  walk.duration_s = 8.0;
  walk.range_sigma_m = 0.004;  // RANSAC's band is 1 cm
  const std::vector<Eigen::Vector2d> way = {{1.0, 1.0}, {5.0, 1.0}, {5.0, 3.0}, {2.0, 3.0}};
  const synthetic::Recording recording = synthetic::walk(synthetic::one_room(), way, walk);
  for (const SGraphsPlusConfig& config :
       {SGraphsPlusConfig(SGraphsPlusAllWallsConfig()), SGraphsPlusConfig(SGraphsConfig())}) {
    const Walked r = run(recording, config);
    EXPECT_LT(ate(r.causal, r.truth), 0.03);
    EXPECT_EQ(r.estimate.floors.size(), config.parts.floors ? 1U : 0U);
    ASSERT_EQ(r.estimate.rooms.size(), 1U);
    EXPECT_EQ(r.estimate.rooms[0].kind, RoomKind::four_wall);
    EXPECT_NEAR(std::abs(signed_area(r.estimate.rooms[0].polygon_F)), 24.0, 1.0);
    EXPECT_EQ(run(recording, config).digest, r.digest);
  }
}

TEST(SGraphsPlus, GivesTheSameDigestsTwice) {
  synthetic::WalkConfig walk;
  walk.duration_s = 4.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  EXPECT_EQ(run(recording).digest, run(recording).digest);
}

}  // namespace
}  // namespace plumbline::slam
