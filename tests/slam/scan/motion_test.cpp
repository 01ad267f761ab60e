// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

Pose straight(double t) { return Pose::from_xyz_yaw({0.6 * t, 0.1 * t, 0.0}, 0.5 * t); }

MotionBuffer buffer(Nanoseconds until) {
  MotionBuffer motion;
  for (Nanoseconds t = 0; t <= until; t += 10'000'000) motion.add({t, straight(seconds(t))});
  return motion;
}

void expect_pose_near(const Pose& a, const Pose& b, double tolerance) {
  EXPECT_LT(log_se3(a.inverse() * b).norm(), tolerance);
}

TEST(MotionBufferTest, InterpolatesBetweenRecordsAndGoesOnAfterTheLast) {
  const MotionBuffer motion = buffer(100'000'000);
  for (const Nanoseconds t : {0LL, 10'000'000LL, 33'300'000LL, 99'999'999LL, 100'000'000LL, 108'000'000LL})
    expect_pose_near(motion.at(t), straight(seconds(t)), 1e-9);
}

TEST(MotionBufferTest, StopsAtItsEnds) {
  const MotionBuffer motion = buffer(100'000'000);
  expect_pose_near(motion.at(-5), straight(0.0), 1e-12);
  expect_pose_near(motion.at(500'000'000), straight(0.1 + seconds(motion.max_age())), 1e-9);
}

TEST(MotionBufferTest, ForgettingKeepsWhatLaterTimesNeed) {
  MotionBuffer motion = buffer(1'200'000'000);
  motion.forget_before(55'000'000);
  expect_pose_near(motion.at(55'000'000), straight(0.055), 1e-9);
  expect_pose_near(motion.at(20'000'000), straight(0.05), 1e-9);
  motion.forget_before(1'100'000'000);
  expect_pose_near(motion.at(20'000'000), straight(0.2), 1e-9);
}

TEST(MotionBufferTest, TellsTheLongestGapBetweenTwoTimes) {
  MotionBuffer motion = buffer(1'000'000'000);
  EXPECT_EQ(motion.longest_gap(200'000'000, 500'000'000), 10'000'000);
  motion.add({2'500'000'000, straight(2.5)});
  motion.add({2'510'000'000, straight(2.51)});
  EXPECT_EQ(motion.longest_gap(900'000'000, 2'505'000'000), 1'500'000'000);
  EXPECT_EQ(motion.longest_gap(2'200'000'000, 2'505'000'000), 300'000'000);
  EXPECT_EQ(motion.longest_gap(2'505'000'000, 2'510'000'000), 5'000'000);
  EXPECT_EQ(motion.longest_gap(3'000'000'000, 4'000'000'000), 0);  // nothing says that more is to come
}

// What was recorded at t is stamped t + offset: steps from a scan on are those of the robot, and its pose does not
// jump.
TEST(MotionBufferTest, AClockOffsetMovesTheStampsAndNotTheRobot) {
  const Stream draws(7, "bim.generate");
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    const auto offset = static_cast<Nanoseconds>(200e6 * (2.0 * draws.uniform(trial) - 1.0));
    const Nanoseconds scan = 600'000'000;
    MotionBuffer motion;
    Nanoseconds t = 0;
    for (; t <= scan; t += 10'000'000) motion.add({t, straight(seconds(t - offset))});
    const Pose before = motion.at(scan);
    motion.set_clock_offset(offset, scan);
    expect_pose_near(motion.at(scan), before, 1e-9);
    for (; t <= scan + 400'000'000; t += 10'000'000) motion.add({t, straight(seconds(t - offset))});
    EXPECT_EQ(motion.age_at(scan + 100'000'000), 0);
    expect_pose_near(motion.at(scan).inverse() * motion.at(scan + 100'000'000),
                     straight(seconds(scan)).inverse() * straight(seconds(scan + 100'000'000)), 1e-9);
  }
}

TEST(MotionBufferTest, LateOdometryIsStaleLater) {
  MotionBuffer motion = buffer(1'000'000'000);
  EXPECT_TRUE(motion.is_stale_at(1'160'000'000));
  motion.set_clock_offset(200'000'000, 1'000'000'000);
  EXPECT_EQ(motion.age_at(1'000'000'000), 200'000'000);
  EXPECT_FALSE(motion.is_stale_at(1'000'000'000));
  EXPECT_TRUE(motion.is_stale_at(1'160'000'000));
}

// A jump of the odometry's frame is none of the robot: what came before and after joins without it.
TEST(MotionBufferTest, JumpsAndNonsenseAreNoMotion) {
  const Pose jump = Pose::from_xyz_yaw({1000.0, -500.0, 3.0}, 0.65);
  MotionBuffer motion;
  for (Nanoseconds t = 0; t <= 50'000'000; t += 10'000'000) motion.add({t, straight(seconds(t))});
  Pose nonsense = straight(0.055);
  nonsense.t.y() = std::nan("");
  motion.add({55'000'000, nonsense});
  for (Nanoseconds t = 60'000'000; t <= 100'000'000; t += 10'000'000) motion.add({t, jump * straight(seconds(t))});
  expect_pose_near(motion.at(50'000'000), straight(0.05), 1e-9);
  expect_pose_near(motion.at(60'000'000), straight(0.05), 1e-9);
  // 1 km away a double holds 1e-13 m.
  expect_pose_near(motion.at(60'000'000).inverse() * motion.at(100'000'000), straight(0.06).inverse() * straight(0.1),
                   1e-9);
}

// Gravity does not jump: the IMU's tilt before and after is valid in one frame.
TEST(MotionBufferTest, JumpsLeaveTheTiltAsItIsTold) {
  const Pose jump = Pose::from_xyz_yaw({20.0, -5.0, 1.0}, 0.65);
  const auto swaying = [](double t) {
    return straight(t) * Pose{exp_so3({0.05 * std::sin(40.0 * t), 0.03, 0.0}), Eigen::Vector3d::Zero()};
  };
  MotionBuffer motion;
  for (Nanoseconds t = 0; t <= 50'000'000; t += 10'000'000) motion.add({t, swaying(seconds(t))});
  for (Nanoseconds t = 60'000'000; t <= 100'000'000; t += 10'000'000) motion.add({t, jump * swaying(seconds(t))});
  for (Nanoseconds t = 60'000'000; t <= 100'000'000; t += 10'000'000) {
    const Eigen::Vector3d up_R = motion.at(t).q.conjugate() * Eigen::Vector3d::UnitZ();
    EXPECT_LT((up_R - swaying(seconds(t)).q.conjugate() * Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
  EXPECT_LT((motion.at(60'000'000).t - motion.at(50'000'000).t).norm(), 1e-9);
  EXPECT_NEAR(motion.at(60'000'000).yaw(), motion.at(50'000'000).yaw(), 1e-9);
}

TEST(MotionBufferTest, IsSilentOnceItsNewestRecordIsOld) {
  EXPECT_TRUE(MotionBuffer().is_stale_at(0));
  const MotionBuffer motion = buffer(100'000'000);
  EXPECT_EQ(motion.max_age(), MotionBuffer::least_max_age);
  EXPECT_FALSE(motion.is_stale_at(100'000'000 + motion.max_age()));
  EXPECT_TRUE(motion.is_stale_at(100'000'001 + motion.max_age()));
  synthetic::WalkConfig walk;
  walk.duration_s = 0.45;
  const synthetic::Recording recording = synthetic::walk(synthetic::one_room(), {{1.0, 1.0}, {3.0, 1.0}}, walk);
  ASSERT_EQ(recording.scans.size(), 4U);
  EXPECT_FALSE(deskew(recording.scans[1], motion, recording.calibration).odometry_stale);
  EXPECT_TRUE(deskew(recording.scans[3], motion, recording.calibration).odometry_stale);
}

// Until the odometry is stale its motion is taken to go on: what is called valid is the motion until then.
TEST(MotionBufferTest, GoesOnUntilItIsStale) {
  for (const Nanoseconds period : {10'000'000, 100'000'000, 200'000'000, 500'000'000, 2'000'000'000}) {
    MotionBuffer motion;
    for (Nanoseconds t = 0; t <= 3 * period; t += period) motion.add({t, straight(seconds(t))});
    EXPECT_GE(motion.max_age(), std::min<Nanoseconds>(period, MotionBuffer::most_max_age));
    for (Nanoseconds age = 0; age <= motion.max_age(); age += 10'000'000) {
      const Nanoseconds t = 3 * period + age;
      EXPECT_EQ(motion.age_at(t), age);
      EXPECT_LT((motion.at(t).t - straight(seconds(t)).t).norm(), 1e-9) << period << ", " << age;
    }
  }
}

// As when a buffer is read now and then: all records of a read have its time, microseconds apart. 13 m off before.
TEST(MotionBufferTest, StampsInBurstsAreNoVelocity) {
  constexpr Nanoseconds least_step = 1000, scan = 100'000'000;
  const double speed_mps = straight(1.0).t.norm();
  for (const Nanoseconds period : {2'000'000, 5'000'000, 20'000'000})
    for (const Nanoseconds burst : {50'000'000, 100'000'000, 101'000'000, 200'000'000}) {
      MotionBuffer motion;
      Nanoseconds last = 0, next_scan = scan;
      for (Nanoseconds t = period; t <= 5'000'000'000; t += period) {
        const Nanoseconds read = (t / burst + 1) * burst;
        for (; next_scan < read && !motion.empty(); next_scan += scan) {
          if (next_scan < last) continue;
          const Pose X_OR = motion.at(next_scan);
          // What is known is a burst old, and as much older as stamps are late; the speed that goes on is at most
          // twice.
          const double most_s = seconds(next_scan - last) + 2.0 * seconds(burst);
          EXPECT_LT((X_OR.t - straight(seconds(next_scan)).t).norm(), speed_mps * most_s)
              << period << ", " << burst << " at " << next_scan;
          motion.forget_before(next_scan);
        }
        last = std::max(read, last + least_step);
        motion.add({last, straight(seconds(t))});
      }
    }
}

// By more than the period.
TEST(MotionBufferTest, StampsThatScatterAreNoVelocity) {
  constexpr Nanoseconds period = 5'000'000, least_step = 1000, later = 10'000'000;
  constexpr double sigma_s = 0.008, most = 3.0;
  const Stream stream(7, "bim.generate");
  const double speed_mps = straight(1.0).t.norm();
  MotionBuffer motion;
  Nanoseconds last = 0;
  for (std::uint64_t k = 1; k <= 400; ++k) {
    const Nanoseconds t = static_cast<Nanoseconds>(k) * period;
    const Nanoseconds off = std::llround(1e9 * sigma_s * std::clamp(stream.gauss(k, 0), -most, most));
    last = std::max(t + off, last + least_step);
    motion.add({last, straight(seconds(t))});
    const Nanoseconds at = last + later;
    // A stamp is off by three standard deviations, and a velocity goes on over 10 ms that is at most twice too fast.
    EXPECT_LT((motion.at(at).t - straight(seconds(at)).t).norm(), speed_mps * (2.0 * most * sigma_s + seconds(later)))
        << k;
    if (k % 20 == 0) motion.forget_before(last);
  }
}

TEST(MotionBufferTest, RefusesToGuess) {
  MotionBuffer motion;
  EXPECT_THROW((void)motion.at(0), InternalError);
  motion.add({10, Pose{}});
  EXPECT_THROW(motion.add({9, Pose{}}), InternalError);
}

// Without noise every deskewed return of an empty room must lie on a wall, the floor or the ceiling. What is left is 1
// mm of rounding to 2 mm and the interpolation between 100 Hz records, worst where the turn rate jumps (measured 4.3
// mm).
TEST(DeskewTest, PutsReturnsOfATurningRobotBackOntoTheRoom) {
  synthetic::WalkConfig config;
  config.range_sigma_m = 0.0;
  config.odometry_sigma = 0.0;
  config.odometry_yaw_sigma = 0.0;
  config.duration_s = 3.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::one_room(), {{1.0, 1.0}, {2.0, 1.2}, {2.0, 3.0}, {4.0, 3.0}}, config);
  ASSERT_GE(recording.scans.size(), 25U);
  MotionBuffer motion;
  for (const Odometry& odometry : recording.odometry) motion.add(odometry);

  double worst = 0.0;
  double worst_raw = 0.0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    const DeskewedScan scan = deskew(recording.scans[k], motion, recording.calibration);
    const Pose X_WL = recording.truth[k].X_FR * recording.calibration.X_RL;
    const auto off_surface = [](const Eigen::Vector3d& p) {
      const double walls = std::min({std::abs(p.x()), std::abs(p.x() - 6.0), std::abs(p.y()), std::abs(p.y() - 4.0)});
      return std::min({walls, std::abs(p.z()), std::abs(p.z() - 2.8)});
    };
    for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
      if (scan.range_m[i] == 0.0) continue;
      worst = std::max(worst, off_surface(recording.truth[k].X_FR * scan.point_R[i]));
      worst_raw = std::max(worst_raw, off_surface(X_WL * recording.scans[k].point_L[i]));
    }
  }
  EXPECT_LT(worst, 0.006);
  EXPECT_GT(worst_raw, 0.05) << "the walk is too slow to test anything";
}

TEST(DeskewedScanTest, PointsBetweenRangesComeInTheScansOrder) {
  DeskewedScan scan;
  scan.range_m = {0.0, 2.0, 5.0, 1.0, 3.0};
  for (const double range : scan.range_m) scan.point_R.emplace_back(range, 0.0, 0.0);
  EXPECT_EQ(points_between(scan, 1.0, 3.0),
            (std::vector<Eigen::Vector3d>{scan.point_R[1], scan.point_R[3], scan.point_R[4]}));
}

}  // namespace
}  // namespace plumbline::slam
