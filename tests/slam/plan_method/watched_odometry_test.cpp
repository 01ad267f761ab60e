// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/watched_odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct Followed {
  double worst_m = 0.0;  ///< farthest from the truth
  double last_m = 0.0;   ///< from it at the end
  int by_scans = 0;      ///< scans that scan matching gave the pose of
  bool by_scans_at_end = false;
  bool as_odometry = true;  ///< every pose is odometry's to the last bit
  int unknown = 0;          ///< scans to which the way is not known
};

using Driver = std::function<void(Odometry record, MotionBuffer& motion)>;

/// A walk of 12 s through the house, whose odometry a driver passes on.
Followed follow(const Driver& driver, double blind_from_s = 1e9) {
  synthetic::WalkConfig walk;
  walk.speed_mps = 0.6;
  walk.duration_s = 12.0;
  walk.vibration = 0.3;
  walk.odometry_sigma = walk.odometry_yaw_sigma = 0.0;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  WatchedOdometry watched(recording.calibration);
  MotionBuffer motion;
  Followed result;
  std::size_t record = 0;
  std::optional<Pose> X_FO;  // truth's frame
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    Scan scan = recording.scans[k];
    for (; record < recording.odometry.size() && recording.odometry[record].stamp <= scan.stamp; ++record)
      driver(recording.odometry[record], motion);
    if (motion.empty()) continue;
    if (seconds(scan.stamp) > blind_from_s) std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0);
    const WatchedOdometry::Tracked tracked = watched.track(scan, motion, 0);
    if (!X_FO) X_FO = recording.truth[k].X_FR * tracked.X_OR.inverse();
    result.last_m = ((*X_FO * tracked.X_OR).t - recording.truth[k].X_FR.t).norm();
    result.worst_m = std::max(result.worst_m, result.last_m);
    result.by_scans += watched.is_by_scans() ? 1 : 0;
    result.as_odometry = result.as_odometry && tracked.X_OR.t == motion.at(scan.stamp).t && !tracked.deskewed;
    result.unknown += tracked.is_way_known ? 0 : 1;
    motion.forget_before(scan.stamp - 1'000'000'000);
  }
  result.by_scans_at_end = watched.is_by_scans();
  return result;
}

/// Passes on what was recorded outside of a gap.
Driver silent(double from_s, double to_s) {
  return [=](const Odometry& record, MotionBuffer& motion) {
    if (seconds(record.stamp) < from_s || seconds(record.stamp) > to_s) motion.add(record);
  };
}

/// In a gap stamps go on, and the pose stands.
Driver standing(double from_s, double to_s) {
  return [=, last = std::optional<Pose>()](Odometry record, MotionBuffer& motion) mutable {
    if (seconds(record.stamp) < from_s || seconds(record.stamp) > to_s) last = record.X_OR;
    record.X_OR = *last;
    motion.add(record);
  };
}

TEST(WatchedOdometry, IsOdometryWhereThatGoesOn) {
  const Followed walked = follow(silent(100.0, 100.0));
  EXPECT_TRUE(walked.as_odometry);
  EXPECT_EQ(walked.by_scans, 0);
  EXPECT_LT(walked.worst_m, 0.01);
}

// The robot goes 3.6 m in 6 s, and 1.8 m in 3 s.
TEST(WatchedOdometry, ScansTakeOverWhereItFallsSilentOrStandsUntilItGoesOn) {
  constexpr double never = 100.0;
  for (const double until_s : {9.0, never})
    for (const bool stands : {false, true}) {
      const Followed walked = follow(stands ? standing(6.0, until_s) : silent(6.0, until_s));
      EXPECT_GT(walked.by_scans, until_s == never ? 45 : 20) << stands;
      EXPECT_EQ(walked.by_scans_at_end, until_s == never) << stands;
      EXPECT_EQ(walked.unknown, 0) << stands;
      // Until it is noticed that odometry stands the pose does, too: for 0.3 m and three scans, where a stop is no
      // jump.
      EXPECT_LT(walked.worst_m, stands ? 0.55 : 0.1) << until_s;
    }
}

TEST(WatchedOdometry, ARecordASecondIsTooFew) {
  Nanoseconds next = 0;
  const Followed walked = follow([&](const Odometry& record, MotionBuffer& motion) {
    if (record.stamp < next) return;
    next = record.stamp + 1'000'000'000;
    motion.add(record);
  });
  EXPECT_GT(walked.by_scans, 90);
  EXPECT_LT(walked.worst_m, 0.1);
}

TEST(WatchedOdometry, WithoutEitherTheWayIsNotKnown) { EXPECT_GT(follow(silent(6.0, 100.0), 6.0).unknown, 20); }

synthetic::Recording standing_robot(double duration_s) {
  synthetic::WalkConfig walk;
  walk.duration_s = duration_s;
  walk.speed_mps = 1e-6;
  return synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
}

// Along a bare corridor the view stays as it is, and odometry drifts by 3 %.
TEST(WatchedOdometry, DriftAlongACorridorIsNoContradiction) {
  const synthetic::House corridor = synthetic::one_room(40.0, 2.0);
  synthetic::WalkConfig walk;
  walk.vibration = 0.0;
  walk.odometry_scale = 1.03;
  walk.duration_s = 25.0;
  const synthetic::Recording recording = synthetic::walk(corridor, {{5.0, 1.0}, {35.0, 1.0}}, walk);
  WatchedOdometry watched(recording.calibration);
  MotionBuffer motion;
  for (const Odometry& record : recording.odometry) motion.add(record);
  for (const Scan& scan : recording.scans) {
    (void)watched.track(scan, motion, 0);
    ASSERT_FALSE(watched.is_by_scans()) << seconds(scan.stamp);
  }
}

// Wheels spin for 4 s under a robot that stands, and then it stands on: nothing but the view tells.
TEST(WatchedOdometry, ScansTakeOverWhereWheelsSpin) {
  for (const double speed_mps : {0.3, 0.7}) {
    const synthetic::Recording recording = standing_robot(8.0);
    WatchedOdometry watched(recording.calibration);
    MotionBuffer motion;
    for (const Odometry& record : recording.odometry) {
      const double spun_s = std::clamp(seconds(record.stamp) - 2.0, 0.0, 4.0);
      motion.add(
          {record.stamp, recording.odometry.front().X_OR * Pose::from_xyz_yaw({speed_mps * spun_s, 0.0, 0.0}, 0.0)});
    }
    Pose X_OR;
    for (const Scan& scan : recording.scans) X_OR = watched.track(scan, motion, 0).X_OR;
    EXPECT_TRUE(watched.is_by_scans());
    EXPECT_LT((recording.odometry.front().X_OR.inverse() * X_OR).t.norm(), 0.05) << speed_mps;
  }
}

/// Way that odometry adds from from_s on, within 0.2 s: feet slide under a walking robot.
Driver slipping(const std::vector<double>& from_s, const Eigen::Vector3d& way_O) {
  return [=](Odometry record, MotionBuffer& motion) {
    for (const double from : from_s)
      record.X_OR.t += std::clamp((seconds(record.stamp) - from) / 0.2, 0.0, 1.0) * way_O;
    motion.add(record);
  };
}

TEST(WatchedOdometry, ScansUndoASlip) {
  const Eigen::Vector3d ways_O[] = {{0.2, 0.0, 0.0}, {-0.2, 0.0, 0.0}, {0.0, 0.25, 0.0}, {0.3, -0.3, 0.0}};
  for (const Eigen::Vector3d& way_O : ways_O) {
    const Followed walked = follow(slipping({3.0, 6.05, 9.0}, way_O));
    EXPECT_FALSE(walked.as_odometry);
    EXPECT_EQ(walked.by_scans, 0);
    EXPECT_EQ(walked.unknown, 0);
    // The part of a slip that begins in a sweep may be too little to be noticed until the next one.
    EXPECT_LT(walked.worst_m, 0.25 * way_O.norm() + 0.03) << way_O.transpose();
    EXPECT_LT(walked.last_m, 3 * 0.05) << way_O.transpose();  // each may leave what registration errs by
  }
}

// A robot runs and stops at once. One scan is matched where it would have gone on to; the next ones show that it
// stands, as odometry said.
TEST(WatchedOdometry, OneScanThatShowsASlipIsNotBelievedAgainstTheNext) {
  const synthetic::House room = synthetic::one_room(9.0, 5.0);
  constexpr double stops_at_s = 2.0, speed_mps = 1.2;
  const auto X_WR_at = [&](double t) {
    return Pose::from_xyz_yaw({2.0 + speed_mps * std::min(t, stops_at_s), 2.2, 0.46}, 0.0);
  };
  WatchedOdometry watched(synthetic::calibration());
  MotionBuffer motion;
  const auto add = [&](double t) { motion.add({std::llround(t * 1e9), X_WR_at(t)}); };
  add(0.0);
  double worst_m = 0.0, last_m = 0.0;
  for (int k = 1; k <= 40; ++k) {
    const double t = 0.1 * k;
    for (int i = 9; i >= 0; --i) add(t - 0.01 * i);
    const bool is_wrong = k == 21;
    Scan scan =
        synthetic::standing_scan(room, X_WR_at(t) * Pose{{1.0, 0.0, 0.0, 0.0}, {is_wrong ? 0.12 : 0.0, 0.0, 0.0}},
                                 {.seed = static_cast<std::uint64_t>(k)});
    scan.stamp = std::llround(t * 1e9);
    std::fill(scan.offset_ns.begin(), scan.offset_ns.end(), 0);
    last_m = (watched.track(scan, motion, 0).X_OR.t - X_WR_at(t).t).norm();
    worst_m = std::max(worst_m, last_m);
  }
  EXPECT_GT(worst_m, 0.1) << "the scan that shows a slip was not matched where it shows one";
  EXPECT_LT(last_m, 0.05) << "what registration may err by";
}

// Odometry of few records is extrapolated to a scan, also to one at which a slip is undone.
TEST(WatchedOdometry, ScansUndoASlipOfOdometryThatIsExtrapolated) {
  for (const double at_s : {6.0, 6.02, 6.04, 6.06, 6.08, 6.1, 6.12}) {
    const Driver all = slipping({at_s}, {0.2, 0.0, 0.0});
    Nanoseconds next = 0;
    const Followed walked = follow([&](const Odometry& record, MotionBuffer& motion) {
      if (record.stamp < next) return;
      next = record.stamp + 130'000'000;
      all(record, motion);
    });
    // What registration may err by, and what it drifted: 2 to 7 cm, most where two records share the slip.
    EXPECT_LT(walked.last_m, 0.05 + 0.03) << at_s;
  }
}

// Odometry tells the way over a pause of the scans.
TEST(WatchedOdometry, APauseOfTheScansIsNoSlip) {
  synthetic::WalkConfig walk;
  walk.duration_s = 20.0;
  walk.speed_mps = 1.2;
  walk.vibration = 0.3;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), walk);
  WatchedOdometry watched(recording.calibration);
  MotionBuffer motion;
  for (const Odometry& record : recording.odometry) motion.add(record);
  for (const Scan& scan : recording.scans) {
    const double t = seconds(scan.stamp);
    if ((t > 4.0 && t < 4.8) || (t > 7.0 && t < 8.5) || (t > 11.0 && t < 14.0)) continue;
    const WatchedOdometry::Tracked tracked = watched.track(scan, motion, 0);
    EXPECT_EQ(tracked.X_OR.t, motion.at(scan.stamp).t) << t;
  }
}

// Blind scans do not show which of both it is.
TEST(WatchedOdometry, WithoutScansASlipIsOdometrys) {
  EXPECT_TRUE(follow(slipping({6.0}, {0.2, 0, 0}), 5.0).as_odometry);
}

// A push shows in both.
TEST(WatchedOdometry, AJerkThatScansShowIsNoSlip) {
  synthetic::WalkConfig walk;
  walk.duration_s = 6.0;
  walk.speed_mps = 1e-6;
  const synthetic::House house = synthetic::corridor_house();
  synthetic::Recording recording = synthetic::walk(house, synthetic::corridor_house_walk(), walk);
  const Pose pushed = Pose::from_xyz_yaw({0.2, 0.0, 0.0}, 0.0);
  WatchedOdometry watched(recording.calibration);
  MotionBuffer motion;
  std::size_t next = 0;
  for (std::size_t k = 0; k < recording.scans.size(); ++k) {
    Scan scan = recording.scans[k];
    constexpr double at_s = 3.0;
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp; ++next) {
      Odometry record = recording.odometry[next];
      if (seconds(record.stamp) > at_s) record.X_OR = record.X_OR * pushed;
      motion.add(record);
    }
    if (motion.empty()) continue;
    if (seconds(scan.stamp) > at_s) scan = synthetic::standing_scan(house, recording.truth[k].X_FR * pushed, walk);
    scan.stamp = recording.scans[k].stamp;
    const WatchedOdometry::Tracked tracked = watched.track(scan, motion, 0);
    EXPECT_EQ(tracked.X_OR.t, motion.at(scan.stamp).t) << seconds(scan.stamp);
  }
}

// A robot that stands is no odometry that stands wrongly.
TEST(WatchedOdometry, ARobotMayStand) {
  const synthetic::Recording recording = standing_robot(6.0);
  WatchedOdometry watched(recording.calibration);
  MotionBuffer motion;
  for (const Odometry& record : recording.odometry) {
    Odometry still = record;
    still.X_OR = recording.odometry.front().X_OR;
    motion.add(still);
  }
  for (const Scan& scan : recording.scans) {
    (void)watched.track(scan, motion, 0);
    EXPECT_FALSE(watched.is_by_scans());
  }
}

}  // namespace
}  // namespace plumbline::slam
