// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/slip.h"

#include <gtest/gtest.h>

#include <array>

#include "sim/robot/leg_odometry.h"
#include "sim/robot/types/kinematics.h"
#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

/// A robot that stands on all feet.
Proprioception standing() {
  Proprioception truth;
  for (std::size_t leg = 0; leg < leg_count; ++leg) {
    const Eigen::Vector3d below(0.0, side_sign(leg) * robot_dimensions.abduction, -0.47);
    const LegAngles angles = leg_angles(leg, hip_R(leg) + below);
    for (std::size_t joint = 0; joint < 3; ++joint) truth.q[3 * leg + joint] = angles(static_cast<Eigen::Index>(joint));
    truth.touch[leg] = 80.0;
  }
  truth.accelerometer_R = {0.0, 0.0, 9.81};
  return truth;
}

TEST(Slips, AreNoneByDefault) {
  const Slips slips({}, step_s, 1);
  for (std::int64_t step = 0; step < 20000; ++step) ASSERT_TRUE(slips.velocity_R(step).isZero(0.0));
}

TEST(Slips, OneEpisodeInEachSpanOfItsLengthAndSpeed) {
  const SlipConfig config{0.3, 0.2, 4.0};
  const Slips slips(config, step_s, 7);
  for (std::int64_t span = 0; span < 10; ++span) {
    int slipping = 0, starts = 0;
    bool before = false;
    for (std::int64_t step = 2000 * span; step < 2000 * (span + 1); ++step) {
      const Eigen::Vector3d v_R = slips.velocity_R(step);
      const bool now = !v_R.isZero(0.0);
      if (now) {
        EXPECT_NEAR(v_R.norm(), 0.3, 1e-12);
      }
      EXPECT_EQ(v_R.z(), 0.0);
      starts += now && !before ? 1 : 0;
      slipping += now ? 1 : 0;
      before = now;
    }
    EXPECT_EQ(starts, 1) << span;
    EXPECT_EQ(slipping, 100) << span;
  }
}

/// Odometry believes that feet hold, so that the robot seems to move the other way.
TEST(Slips, OdometryShowsMotionThatIsNone) {
  const SlipConfig config{0.3, 0.2, 4.0};
  ProprioceptiveSensors sensors(OdometryPreset::ideal, 7, {}, config), sure(OdometryPreset::ideal, 7);
  LegOdometry legs(leg_odometry_config(OdometryPreset::ideal, 7)), held(leg_odometry_config(OdometryPreset::ideal, 7));
  const Slips slips(config, step_s, 7);
  Eigen::Vector3d slid = Eigen::Vector3d::Zero();
  for (std::int64_t step = 0; step < 2000; ++step) {
    legs.update(sensors.read(standing(), step), step_s);
    held.update(sure.read(standing(), step), step_s);
    slid += step_s * slips.velocity_R(step);
  }
  ASSERT_NEAR(slid.norm(), 0.06, 1e-9);
  EXPECT_LT(held.X_OR().t.norm(), 1e-6);
  // The shank turns as the foot slides, which odometry takes for rolling: radius over leg length of 7 %, and damping.
  EXPECT_LT((legs.X_OR().t + slid).head<2>().norm(), 0.12 * 0.06);
}

TEST(Slips, OnlyFeetThatStandSlide) {
  Proprioception truth = standing();
  truth.touch[1] = 0.0;
  const SlipConfig config{0.3, 0.2, 4.0};
  ProprioceptiveSensors sensors(OdometryPreset::ideal, 7, {}, config);
  std::array<bool, 4> moved{};
  for (std::int64_t step = 0; step < 2000; ++step) {
    const SensorReading reading = sensors.read(truth, step);
    for (std::size_t leg = 0; leg < leg_count; ++leg)
      for (std::size_t joint = 0; joint < 3; ++joint)
        if (reading.qd[3 * leg + joint] != 0.0) moved[leg] = true;
    EXPECT_EQ(reading.q, truth.q);
  }
  EXPECT_EQ(moved, (std::array<bool, 4>{true, false, true, true}));
}

}  // namespace
}  // namespace plumbline::sim
