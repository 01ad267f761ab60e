// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/robot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "bim/digest/digest.h"
#include "bim/digest/float_mode.h"
#include "bim/errors.h"

namespace plumbline::sim {
namespace {

const Ground flat;

Robot flat_robot(std::vector<CollisionBox> boxes = {}) {
  return {Pose::from_xyz_yaw({0.0, 0.0, 1.0}, 0.0), flat, std::move(boxes)};
}

CollisionBox wall_at(double x, double yaw = 0.0) {
  CollisionBox box;
  box.X_WB = Pose::from_xyz_yaw({x, 0.0, 1.0}, yaw);
  box.half = {0.1, 3.0, 1.0};
  return box;
}

/// Walks for `seconds` and returns the mean velocity in the heading frame and the yaw rate over the last half.
Eigen::Vector3d steady_velocity(const Command& command, int seconds) {
  Robot robot = flat_robot();
  const int steps = 500 * seconds;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double yaw = robot.X_WR().yaw();
  for (int i = 0; i < steps; ++i) {
    robot.step(command);
    const double yaw_now = robot.X_WR().yaw();
    if (i >= steps / 2) {
      const double s = std::sin(yaw_now);
      const double c = std::cos(yaw_now);
      const Eigen::Vector3d v = robot.v_W();
      sum += Eigen::Vector3d(c * v.x() + s * v.y(), -s * v.x() + c * v.y(), wrap_angle(yaw_now - yaw) / 0.002);
    }
    yaw = yaw_now;
  }
  return sum / (steps - steps / 2);
}

TEST(Robot, StandsStillAndUpright) {
  Robot robot = flat_robot();
  const Pose start = robot.X_WR();
  for (int i = 0; i < 1000; ++i) robot.step({});
  const Pose end = robot.X_WR();
  EXPECT_LT((end.t - start.t).norm(), 0.005);  // measured 1 mm: the last of the settling
  EXPECT_NEAR(end.t.z(), 0.50, 0.01);
  EXPECT_LT(log_so3(end.q).norm(), 0.01);
  EXPECT_LT(robot.v_W().norm(), 0.01);
  EXPECT_NEAR(robot.proprioception().accelerometer_R.z(), 9.81, 0.05);
  double weight = 0.0;
  for (const double touch : robot.proprioception().touch) weight += touch;
  EXPECT_NEAR(weight, 33.6 * 9.81, 3.0);  // statics; 1 % for what still swings
}

TEST(Robot, WalksAMinuteWithTurnsWithoutFalling) {
  Robot robot = flat_robot();
  double z_min = 1.0;
  double z_max = 0.0;
  double tilt_max = 0.0;
  for (int i = 0; i < 30000; ++i) {
    const double turn = 0.8 * std::sin(i * 0.002 * 0.7);
    robot.step({0.8, 0.0, turn, 1.0});
    const Pose X_WR = robot.X_WR();
    z_min = std::min(z_min, X_WR.t.z());
    z_max = std::max(z_max, X_WR.t.z());
    tilt_max = std::max(tilt_max, std::acos((X_WR.q * Eigen::Vector3d::UnitZ()).z()));
  }
  EXPECT_GT(z_min, 0.47);
  EXPECT_LT(z_max, 0.53);
  EXPECT_LT(tilt_max, 6.0 * std::numbers::pi / 180.0);
}

TEST(Robot, TracksVelocities) {
  const Eigen::Vector3d forward = steady_velocity({1.0, 0.0, 0.0, 1.0}, 6);
  EXPECT_NEAR(forward.x(), 1.0, 0.05);
  EXPECT_NEAR(forward.y(), 0.0, 0.03);
  const Eigen::Vector3d backward = steady_velocity({-0.6, 0.0, 0.0, 1.0}, 6);
  EXPECT_NEAR(backward.x(), -0.6, 0.05);
  const Eigen::Vector3d sideways = steady_velocity({0.0, 0.5, 0.0, 1.0}, 6);
  EXPECT_NEAR(sideways.y(), 0.5, 0.05);
  const Eigen::Vector3d turn = steady_velocity({0.0, 0.0, 1.2, 1.0}, 6);
  EXPECT_NEAR(turn.z(), 1.2, 0.08);
}

TEST(Robot, SameCommandsSameDigest) {
  const std::uint64_t digest = [] {
    Robot robot = flat_robot({wall_at(1.5)});
    for (int i = 0; i < 2000; ++i) robot.step({0.5, 0.0, 0.3, 1.0});
    return robot.digest();
  }();
  Robot robot = flat_robot({wall_at(1.5)});
  for (int i = 0; i < 2000; ++i) robot.step({0.5, 0.0, 0.3, 1.0});
  EXPECT_EQ(robot.digest(), digest);
}

TEST(Robot, LeavesTheFloatModeAndTheWorkingDirectoryAlone) {
  set_float_mode();
  Robot robot = flat_robot();
  for (int i = 0; i < 100; ++i) robot.step({0.5, 0.0, 0.0, 1.0});
  EXPECT_EQ(float_mode(), required_float_mode);
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

TEST(Robot, IsStoppedByAWallThatEntersThePoolLate) {
  // The wall is out of the pool's 2 m at the start, so its geom is rewritten while the robot walks.
  Robot robot = flat_robot({wall_at(3.0)});
  double x_max = 0.0;
  for (int i = 0; i < 5000; ++i) {
    robot.step({0.6, 0.0, 0.0, 1.0});
    x_max = std::max(x_max, robot.X_WR().t.x());
  }
  // Face at 2.9 m, nose 0.425 m ahead of the base; the yaw may change when pressed against it.
  EXPECT_GT(x_max, 2.2);
  EXPECT_LT(x_max, 2.6);
}

TEST(Robot, FarBoxesChangeNothing) {
  Robot alone = flat_robot();
  Robot among = flat_robot({wall_at(30.0), wall_at(-30.0)});
  for (int i = 0; i < 1000; ++i) {
    alone.step({0.6, 0.0, 0.2, 1.0});
    among.step({0.6, 0.0, 0.2, 1.0});
  }
  EXPECT_EQ(alone.digest(), among.digest());
}

/// Of more boxes than the pool holds the far ones wait, but none that could be touched.
TEST(Robot, TooManyBoxesToTouchAreAFailure) {
  const auto walls = [](double x) {
    std::vector<CollisionBox> boxes;
    for (int i = 0; i < 65; ++i) {
      boxes.push_back(wall_at(x));
      boxes.back().id = i;
    }
    return boxes;
  };
  EXPECT_NO_THROW(flat_robot(walls(1.7)));
  EXPECT_THROW(flat_robot(walls(0.9)), ScenarioFailure);
}

TEST(Robot, AFallIsAFailureWithTimeAndPlace) {
  // Far beyond what the gait can do, forwards and turning at once.
  Robot robot = flat_robot();
  try {
    for (int i = 0; i < 5000; ++i) robot.step({8.0, 4.0, 12.0, 1.0});
    FAIL() << "kept its feet at " << robot.v_W().norm() << " m/s";
  } catch (const ScenarioFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("the robot fell at "), std::string::npos) << failure.what();
  }
}

TEST(Robot, StandsOnTheFloorOfAnUpperStorey) {
  Robot robot(Pose::from_xyz_yaw({2.0, 1.0, 4.0}, 0.5), Ground(3.1), {});
  const Pose X_WR = robot.X_WR();
  EXPECT_NEAR(X_WR.t.z(), 3.6, 0.01);
  EXPECT_NEAR(X_WR.yaw(), 0.5, 0.01);
}

}  // namespace
}  // namespace plumbline::sim
