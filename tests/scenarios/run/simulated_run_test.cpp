// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/simulated_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/data.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

std::string plan() { return project_file("tests/system/short.plan.yaml"); }

ResolvedScenario resolved_with(const std::string& kidnap) {
  const fs::path file = fs::path(testing::TempDir()) / ("plumbline_walk_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(file) << "scenario: 1\nbuilding: " << fs::absolute(plan()).string()
                      << "\nstart: {room: left}\nroute: {rooms: [hall]}\nduration_s: 4\n"
                      << kidnap;
  ResolvedScenario resolved = resolve(file.string(), {});
  fs::remove(file);
  return resolved;
}

std::vector<sim::WorldFrame> frames_of(const ResolvedScenario& resolved) {
  SimulatedRun run(resolved);
  std::vector<sim::WorldFrame> frames(1);
  while (run.next(frames.back())) frames.emplace_back();
  frames.pop_back();
  return frames;
}

TEST(SimulatedRun, AKidnappedRobotWalksOnFromElsewhereAndItsSensorsNoticeNoMore) {
  const ResolvedScenario free = resolved_with(""),
                         taken = resolved_with("kidnap: {after_s: 1.5, away_s: 1, to: {room: right, yaw_deg: 90}}\n");
  ASSERT_FALSE(free.world_after);
  ASSERT_TRUE(taken.world_after);
  const Eigen::Vector2d place_W = taken.world_after->start_W;
  EXPECT_EQ(taken.scenario.kidnap->to.at, place_W);
  ASSERT_GT((place_W - taken.world.start_W).norm(), 2.0);

  const std::vector<sim::WorldFrame> alone = frames_of(free), frames = frames_of(taken);
  std::size_t down = 1;
  while (down < frames.size() && frames[down].sensors.scan.stamp - frames[down - 1].sensors.scan.stamp < 500'000'000)
    ++down;
  ASSERT_LT(down, frames.size() - 5);
  ASSERT_GT(down, 10U);
  for (std::size_t i = 0; i < down; ++i) {
    EXPECT_EQ(frames[i].truth.robot_digest, alone[i].truth.robot_digest);
    EXPECT_EQ(frames[i].sensors.scan.range_m, alone[i].sensors.scan.range_m);
  }
  const sim::WorldFrame &last = frames[down - 1], &first = frames[down];
  EXPECT_LE(slam::seconds(last.sensors.scan.stamp), 1.5);
  EXPECT_GE(slam::seconds(first.sensors.odometry.front().stamp - last.sensors.scan.stamp), 1.0);
  EXPECT_LT(slam::seconds(first.sensors.odometry.front().stamp - last.sensors.scan.stamp), 1.01);
  EXPECT_LE(slam::seconds(frames.back().sensors.scan.stamp), 4.0);
  EXPECT_LT((first.truth.poses.front().X_WR.t.head<2>() - place_W).norm(), 0.05);
  // Odometry knows nothing of it.
  EXPECT_LT((first.sensors.odometry.front().X_OR.t - last.sensors.odometry.back().X_OR.t).norm(), 1e-9);
  EXPECT_NEAR(first.sensors.odometry.front().X_OR.yaw(), last.sensors.odometry.back().X_OR.yaw(), 1e-9);
  slam::Nanoseconds stamp = -1;
  for (const sim::WorldFrame& frame : frames) {
    for (const slam::Odometry& odometry : frame.sensors.odometry) {
      EXPECT_GT(odometry.stamp, stamp);
      stamp = odometry.stamp;
    }
    EXPECT_LE(frame.sensors.imu.back().stamp, frame.sensors.scan.stamp);
    EXPECT_EQ(frame.truth.poses.back().stamp, frame.sensors.scan.stamp);
    for (const slam::Vlp16Packet& packet : frame.sensors.packets) {
      std::int64_t us = 0;
      for (std::size_t i = 4; i-- > 0;) us = us << 8 | packet.payload[1200 + i];
      EXPECT_EQ(us, packet.stamp / 1000);
    }
  }
}

TEST(SimulatedRun, NoiseDoesNotBeginAnewWhereARobotIsSetDown) {
  const sim::WorldConfig start = resolved_with("").world;
  std::ostringstream kidnap;
  kidnap << "kidnap: {after_s: 1.5, away_s: 1, to: {at: [" << start.start_W.x() << ", " << start.start_W.y()
         << "], yaw_deg: " << start.start_yaw * 180.0 / M_PI << "}}\n";
  const std::vector<sim::WorldFrame> frames = frames_of(resolved_with(kidnap.str()));
  std::size_t down = 1;
  while (down < frames.size() && frames[down].sensors.scan.stamp - frames[down - 1].sensors.scan.stamp < 500'000'000)
    ++down;
  ASSERT_LT(down, frames.size());
  const sim::WorldFrame &first = frames.front(), &again = frames[down];
  ASSERT_LT((again.truth.poses.front().X_WR.t - first.truth.poses.front().X_WR.t).norm(), 0.01);
  EXPECT_GT((again.sensors.imu.front().angular_velocity_R - first.sensors.imu.front().angular_velocity_R).norm(), 1e-6);
  ASSERT_EQ(again.sensors.scan.range_m.size(), first.sensors.scan.range_m.size());
  std::size_t seen = 0, same = 0;
  for (std::size_t i = 0; i < first.sensors.scan.range_m.size(); ++i) {
    if (first.sensors.scan.range_m[i] <= 0.0) continue;
    ++seen;
    same += again.sensors.scan.range_m[i] == first.sensors.scan.range_m[i];
  }
  // Ranges come in steps of 2 mm, and their noise is 8 mm or more: a tenth may be equal by chance.
  ASSERT_GT(seen, 1000U);
  EXPECT_LT(same, seen / 5);
}

TEST(SimulatedRun, TheDrawOfThePlaceIsKeptInTheScenario) {
  const ResolvedScenario drawn = resolved_with("kidnap: {after_s: 1, away_s: 1, to: {random: rooms}}\n");
  const Start& to = drawn.scenario.kidnap->to;
  ASSERT_TRUE(to.at && to.yaw_deg && to.storey);
  EXPECT_FALSE(to.random);
  EXPECT_GT((*to.at - drawn.world.start_W).norm(), 0.1);
  EXPECT_EQ(drawn.world_after->start_W, *to.at);
  EXPECT_EQ(read_scenario(write_scenario(drawn.scenario), "written").scenario.kidnap->to.at, to.at);
}

}  // namespace
}  // namespace plumbline::scenarios
