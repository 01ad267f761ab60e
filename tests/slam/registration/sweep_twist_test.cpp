// SPDX-License-Identifier: Apache-2.0
#include "slam/registration/sweep_twist.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "bim/random/stream.h"
#include "slam/registration/vgicp.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

OdometrySample standing() {
  OdometrySample sample;
  sample.q_OR = Eigen::Quaterniond::Identity();
  return sample;
}

const Pose X_WR = Pose::from_xyz_yaw({2.2, 4.0, 0.46}, 0.4);

/// A scan of a robot that stands, as if it had been deskewed by a motion that was not made.
DeskewedScan bent_scan(const Vector6d& twist, std::uint64_t seed, bool rings) {
  synthetic::WalkConfig walk;
  walk.seed = seed;
  Scan raw = synthetic::standing_scan(synthetic::corridor_house(), X_WR, walk);
  if (!rings) {
    raw.columns *= raw.rings;
    raw.rings = 1;
  }
  MotionBuffer still;
  still.add({0, Pose{}});
  DeskewedScan scan = deskew(raw, still, synthetic::calibration());
  correct_motion(scan, -twist);
  scan.twist_sigma = {0.5, 1.0};
  return scan;
}

Vector6d random_twist(std::uint64_t k) {
  const Stream random(5, "bim.generate");
  Vector6d twist;
  for (std::uint32_t i = 0; i < 6; ++i) twist(i) = (i < 3 ? 0.5 : 0.7) * (2.0 * random.uniform(k, i) - 1.0);
  return twist;
}

TEST(CorrectMotion, UndoesItself) {
  const Vector6d twist = random_twist(3);
  const DeskewedScan straight = bent_scan(Vector6d::Zero(), 1, true);
  DeskewedScan scan = bent_scan(twist, 1, true);
  correct_motion(scan, twist);
  ASSERT_EQ(scan.time_s.size(), scan.point_R.size());
  for (std::size_t i = 0; i < scan.point_R.size(); ++i) EXPECT_LT((scan.point_R[i] - straight.point_R[i]).norm(), 1e-9);
}

// Of the error that deskewing by a mean motion makes at the first return of a sweep, most goes.
TEST(SweepTwist, IsFoundTogetherWithThePose) {
  for (const bool rings : {true, false}) {
    double before = 0.0, after = 0.0;
    for (std::uint64_t k = 0; k < 6; ++k) {
      VgicpOdometry odometry{VgicpConfig{}};
      const OdometrySample still = standing();
      odometry.commit(odometry.match(bent_scan(Vector6d::Zero(), 10 + k, rings), still).X_MR, true);
      const Vector6d twist = random_twist(k);
      const Registration result = odometry.match(bent_scan(twist, 30 + k, rings), still);
      constexpr double sweep_s = 0.1, range_m = 3.0;
      const auto bend = [&](const Vector6d& error) {
        return sweep_s * (error.head<3>().norm() + range_m * error.tail<3>().norm());
      };
      before += bend(twist);
      after += bend(twist - result.sweep_twist);
      EXPECT_LT(result.X_MR.t.norm(), 0.03) << k;
    }
    EXPECT_LT(after, 0.35 * before) << "rings " << rings;
  }
}

/// What the correction of a scan in the middle of this room is, where it is known as well as of one at 10 Hz.
Vector6d twist_in(const synthetic::House& house, const Eigen::Vector3d& at, double radps) {
  const auto scan_of = [&](std::uint64_t seed) {
    synthetic::WalkConfig walk;
    walk.seed = seed;
    MotionBuffer still;
    still.add({0, Pose{}});
    return deskew(synthetic::standing_scan(house, Pose::from_xyz_yaw(at, 0.4), walk), still, synthetic::calibration());
  };
  VgicpOdometry odometry{VgicpConfig{}};
  odometry.commit(odometry.match(scan_of(1), standing()).X_MR, true);
  DeskewedScan scan = scan_of(2);
  Vector6d twist = Vector6d::Zero();
  twist(5) = 0.1;
  correct_motion(scan, -twist);
  scan.twist_sigma = {0.1, radps, 0.18};
  return odometry.match(scan, standing()).sweep_twist;
}

// By 0.02 rad a scan is bent as a whole pace in a hall, and hardly in a room.
TEST(SweepTwist, IsSoughtWhereItMovesWhatIsSeen) {
  synthetic::House hall = synthetic::one_room(60.0, 40.0);
  hall.height_m = 8.0;
  for (synthetic::Box& wall : hall.boxes) wall.max.z() = hall.height_m;
  const Vector6d in_hall = twist_in(hall, {30.0, 20.0, 0.5}, 0.2);
  EXPECT_NEAR(in_hall(5), 0.1, 0.03);
  EXPECT_TRUE(twist_in(synthetic::one_room(), {3.0, 2.0, 0.5}, 0.2).isZero(0.0));
  EXPECT_FALSE(twist_in(synthetic::one_room(), {3.0, 2.0, 0.5}, 0.4).isZero(0.0));
}

TEST(SweepTwist, AMotionThatWasMeasuredStays) {
  VgicpOdometry odometry{VgicpConfig{}};
  const OdometrySample still = standing();
  odometry.commit(odometry.match(bent_scan(Vector6d::Zero(), 1, true), still).X_MR, true);
  DeskewedScan scan = bent_scan(random_twist(1), 2, true);
  scan.twist_sigma = {};
  EXPECT_TRUE(odometry.match(scan, still).sweep_twist.isZero(0.0));
}

}  // namespace
}  // namespace plumbline::slam
