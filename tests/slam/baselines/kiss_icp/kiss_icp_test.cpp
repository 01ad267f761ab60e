// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/kiss_icp/kiss_icp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

/// A room of 9 x 6 m with a table, shelves, columns and boxes.
synthetic::House furnished_room() {
  synthetic::House house = synthetic::one_room(9.0, 6.0);
  for (const synthetic::Box& box :
       {synthetic::Box{{6.0, 1.0, 0.0}, {7.4, 2.0, 0.75}}, synthetic::Box{{0.0, 2.0, 0.0}, {0.4, 4.0, 2.0}},
        synthetic::Box{{2.5, 5.4, 0.0}, {4.0, 6.0, 1.8}}, synthetic::Box{{5.0, 4.5, 0.0}, {5.3, 4.8, 2.8}},
        synthetic::Box{{8.2, 4.6, 0.0}, {9.0, 6.0, 1.2}}, synthetic::Box{{2.0, 0.6, 0.0}, {2.3, 0.9, 2.8}}})
    house.boxes.push_back(box);
  return house;
}

MethodInput input() {
  MethodInput given;
  given.calibration = synthetic::calibration();
  return given;
}

synthetic::WalkConfig without_noise() {
  synthetic::WalkConfig config;
  config.range_sigma_m = 0.0;
  config.dropout = 0.0;
  config.vibration = 0.0;
  return config;
}

/// Poses X_MR of every `step`th scan.
std::vector<Pose> follow(const synthetic::Recording& recording, const KissIcpConfig& config, std::size_t step = 1) {
  const auto method = make_kiss_icp(input(), config);
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < recording.scans.size(); k += step)
    poses.push_back(*method->on_scan(recording.scans[k]).X_FR);
  return poses;
}

double worst_error(const synthetic::Recording& recording, const KissIcpConfig& config, std::size_t step = 1) {
  const std::vector<Pose> poses = follow(recording, config, step);
  double worst = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Pose X_WR = recording.truth.front().X_FR * poses[k];
    worst = std::max(worst, (X_WR.t - recording.truth[k * step].X_FR.t).norm());
  }
  return worst;
}

TEST(KissIcp, StartsAtIdentityAndFillsItsMap) {
  const Pose X_WR = Pose::from_xyz_yaw({3.0, 3.0, 0.46}, 0.2);
  const auto method = make_kiss_icp(input(), KissIcpIndoorConfig());
  const Output output = method->on_scan(synthetic::standing_scan(furnished_room(), X_WR, {}));
  ASSERT_TRUE(output.X_FR.has_value());
  EXPECT_EQ(output.X_FR->t, Eigen::Vector3d::Zero());
  EXPECT_EQ(output.X_FR->q.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(output.state, State::converged);
  EXPECT_EQ(output.digests.size(), 2U);
  EXPECT_GT(method->finish().map_F.size(), 3000U);
}

// Of 16 rings, coarser voxels hold too few points: nearest points then lie along the rings, which move with the LiDAR.
TEST(KissIcp, FindsAStepInAFurnishedRoom) {
  KissIcpIndoorConfig config;
  config.voxel_m = 0.1;
  const Pose from = Pose::from_xyz_yaw({3.0, 3.0, 0.46}, 0.2);
  const Pose to = from * Pose::from_xyz_yaw({0.25, 0.15, 0.0}, 0.0);
  const auto method = make_kiss_icp(input(), config);
  static_cast<void>(method->on_scan(synthetic::standing_scan(furnished_room(), from, without_noise())));
  Scan second = synthetic::standing_scan(furnished_room(), to, without_noise());
  second.stamp += 100'000'000;
  const Pose error = (from.inverse() * to).inverse() * *method->on_scan(second).X_FR;
  EXPECT_LT(error.t.norm(), 0.005);
  EXPECT_LT(log_so3(error.q).norm(), 0.006);
}

TEST(KissIcp, FollowsAWalk) {
  synthetic::WalkConfig walk;
  walk.duration_s = 8.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  EXPECT_LT(worst_error(recording, KissIcpIndoorConfig()), 0.15);
}

TEST(KissIcp, TakesScansWithoutTimesAsTheyAre) {
  synthetic::WalkConfig walk;
  walk.duration_s = 2.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  KissIcpIndoorConfig off;
  off.deskew = false;
  const std::vector<Pose> expected = follow(recording, off);
  synthetic::Recording none = recording, same = recording, one = recording;
  for (Scan& scan : none.scans) scan.offset_ns.clear();
  for (Scan& scan : same.scans) scan.offset_ns.assign(scan.size(), -40'000'000);
  for (Scan& scan : one.scans) scan.offset_ns.assign(1, -40'000'000);
  for (const bool by_interval : {true, false}) {
    KissIcpIndoorConfig on;
    on.deskew_by_interval = by_interval;
    for (const synthetic::Recording* timeless : {&none, &same, &one}) {
      const std::vector<Pose> poses = follow(*timeless, on);
      for (std::size_t k = 0; k < poses.size(); ++k) {
        EXPECT_EQ(poses[k].t, expected[k].t);
        EXPECT_EQ(poses[k].q.coeffs(), expected[k].q.coeffs());
      }
    }
    EXPECT_NE(follow(recording, on).back().t, expected.back().t) << "times do count where there are any";
  }
}

// Every fifth scan of a walk is as good as each of them, once the motion is taken over the interval between scans.
TEST(KissIcp, DeskewsByTheIntervalBetweenScans) {
  synthetic::WalkConfig walk;
  walk.speed_mps = 1.0;
  walk.vibration = 0.0;
  walk.duration_s = 6.0;
  const synthetic::Recording recording = synthetic::walk(furnished_room(), {{1.2, 3.2}, {8.0, 3.2}}, walk);
  const KissIcpIndoorConfig by_interval;
  KissIcpIndoorConfig by_sweep;
  by_sweep.deskew_by_interval = false;
  const double each = worst_error(recording, by_interval), fifth = worst_error(recording, by_interval, 5);
  EXPECT_LT(fifth, 3.0 * each);
  EXPECT_GT(worst_error(recording, by_sweep, 5), 2.0 * fifth);
}

TEST(KissIcp, UsesReturnsAlone) {
  synthetic::WalkConfig walk;
  walk.duration_s = 1.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  const auto with = make_kiss_icp(input(), KissIcpConfig()), without = make_kiss_icp(input(), KissIcpConfig());
  for (const Scan& scan : recording.scans) {
    with->on_odometry({scan.stamp, Pose::from_xyz_yaw({std::nan(""), 0.0, 0.0}, 1.0)});
    with->on_imu({scan.stamp, {5.0, 5.0, 5.0}, {100.0, 0.0, 0.0}});
    EXPECT_EQ(with->on_scan(scan).X_FR->t, without->on_scan(scan).X_FR->t);
  }
}

TEST(KissIcp, AnswersWhateverComes) {
  synthetic::WalkConfig walk;
  walk.duration_s = 3.0;
  synthetic::Recording recording = synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  ASSERT_GT(recording.scans.size(), 28U);
  const auto empty = [](Scan& scan) {
    scan.rings = scan.columns = 0;
    scan.range_m.clear();
    scan.point_L.clear();
    scan.offset_ns.clear();
  };
  empty(recording.scans[0]);
  recording.scans[8].range_m.assign(recording.scans[8].size(), 0.0);
  empty(recording.scans[9]);
  recording.scans[12] = recording.scans[11];  // stamp included
  recording.scans[15].stamp = recording.scans[14].stamp + 1;
  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity(), 1e30, -1e30};
  for (std::size_t i = 0; i < recording.scans[18].size(); i += 2) {
    if (i % 4 == 0) recording.scans[18].range_m[i] = bad[(i / 2) % 4];
    recording.scans[18].point_L[i] = {bad[(i / 2) % 4], 1.0, bad[(i / 2 + 1) % 4]};
  }
  for (std::size_t i = 3; i < recording.scans[21].size(); ++i) recording.scans[21].range_m[i] = 0.0;  // three points

  for (const KissIcpConfig& config : {KissIcpConfig(), KissIcpConfig(KissIcpIndoorConfig())}) {
    const auto method = make_kiss_icp(input(), config);
    for (std::size_t k = 0; k < recording.scans.size(); ++k) {
      const Output output = method->on_scan(recording.scans[k]);
      ASSERT_TRUE(output.X_FR.has_value());
      EXPECT_TRUE(output.X_FR->t.allFinite() && output.X_FR->q.coeffs().allFinite()) << "scan " << k;
      EXPECT_LT(output.X_FR->t.norm(), 20.0) << "scan " << k;
      EXPECT_EQ(output.state == State::lost, k == 0 || k == 8 || k == 9) << "scan " << k;
    }
    EXPECT_EQ(method->finish().trajectory.size(), recording.scans.size());
  }
}

// Constant velocity goes on without end where nothing is seen.
TEST(KissIcp, StaysWithinItsGrid) {
  KissIcpConfig config;
  config.max_range_m = 30.0;
  config.voxel_m = 0.01;  // a grid of 10 km
  config.second_thinning = false;
  const auto method = make_kiss_icp(input(), config);
  const Stream random(7, "bim.generate");
  Scan scan;
  scan.rings = 1;
  scan.columns = 500;
  /// The same points from a place farther along x.
  const auto see = [&](double x) {
    scan.range_m.clear();
    scan.point_L.clear();
    for (std::uint64_t i = 0; i < 500; ++i) {
      scan.point_L.emplace_back(25.0 * random.uniform(i, 0) - x, random.uniform(i, 1), random.uniform(i, 2));
      scan.range_m.push_back(scan.point_L.back().norm());
    }
    scan.stamp += 100'000'000;
    return *method->on_scan(scan).X_FR;
  };
  constexpr double faster_m = 0.008;  // from scan to scan, less than a voxel
  for (int k = 0; k < 50; ++k) static_cast<void>(see(0.5 * faster_m * k * k));
  scan.range_m.assign(500, 0.0);
  double farthest_m = 0.0;
  for (int k = 0; k < 30'000; ++k) {
    scan.stamp += 100'000'000;
    const Output output = method->on_scan(scan);
    ASSERT_TRUE(output.X_FR->t.allFinite());
    farthest_m = std::max(farthest_m, output.X_FR->t.norm());
  }
  EXPECT_GT(farthest_m, 9'000.0) << "the robot is believed to move on, else there is nothing to test";
  EXPECT_LT(farthest_m, 10'000.0);
  EXPECT_NO_THROW(static_cast<void>(see(0.0)));
  EXPECT_NO_THROW(static_cast<void>(method->finish()));
}

TEST(KissIcp, RefusesVoxelsThatAreTooSmall) {
  KissIcpConfig config;
  config.voxel_m = 0.001;
  EXPECT_THROW(static_cast<void>(make_kiss_icp(input(), config)), InputError);
  EXPECT_EQ(KissIcpConfig().map_voxel_m(), 1.0);
  EXPECT_EQ(KissIcpIndoorConfig().map_voxel_m(), 0.3);
}

}  // namespace
}  // namespace plumbline::slam
