// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/conditions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bim/errors.h"
#include "sim/robot/robot.h"
#include "tests/sim/robot/physics_step.h"

namespace plumbline::sim {
namespace {

constexpr double gravity = 9.81;

struct Push {
  std::int64_t begin = 0;
  std::int64_t length = 0;
  Eigen::Vector2d force_W;
};

std::vector<Push> pushes_of(const PushConfig& config, std::uint64_t seed, std::int64_t steps) {
  const Pushes pushes(config, step_s, seed);
  std::vector<Push> out;
  for (std::int64_t step = 0; step < steps; ++step) {
    const Eigen::Vector2d f = pushes.force_W(step);
    if (f.isZero()) continue;
    if (out.empty() || out.back().begin + out.back().length != step) out.push_back({step, 0, f});
    EXPECT_EQ(f, out.back().force_W);
    ++out.back().length;
  }
  return out;
}

TEST(Pushes, AreAsStrongLongAndFrequentAsAskedFor) {
  constexpr std::int64_t span = 3000;
  const std::vector<Push> pushes = pushes_of({.min_n = 40.0, .max_n = 120.0, .every_s = 6.0}, 5, 400 * span);
  ASSERT_EQ(pushes.size(), 400U);
  Eigen::Vector2d directions = Eigen::Vector2d::Zero();
  double mean_n = 0.0;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    EXPECT_EQ(pushes[i].length, 75);
    EXPECT_GE(pushes[i].force_W.norm(), 40.0 - 1e-9);
    EXPECT_LE(pushes[i].force_W.norm(), 120.0 + 1e-9);
    directions += pushes[i].force_W.normalized();
    mean_n += pushes[i].force_W.norm() / 400.0;
    if (i == 0) continue;
    EXPECT_GE(pushes[i].begin - pushes[i - 1].begin, span * 2 / 3 - 1);
    EXPECT_LE(pushes[i].begin - pushes[i - 1].begin, span * 4 / 3 + 1);
  }
  EXPECT_LT(directions.norm(), 4.0 * std::sqrt(400.0 / 2.0) * std::numbers::sqrt2);  // 4 sigma of a random walk
  EXPECT_NEAR(mean_n, 80.0, 4.0 * 80.0 / std::sqrt(12.0 * 400.0));                   // 4 sigma
}

TEST(Pushes, NobodyPushesUnlessAskedToNorBeforeTheStart) {
  EXPECT_TRUE(pushes_of({}, 1, 20000).empty());
  const Pushes pushes({.min_n = 50.0, .max_n = 50.0, .every_s = 1.0}, step_s, 1);
  for (std::int64_t step = -1000; step < 0; ++step) EXPECT_TRUE(pushes.force_W(step).isZero());
}

Robot robot_in(const Conditions& conditions, std::uint64_t seed = 1) {
  return {Pose::from_xyz_yaw({0.0, 0.0, 1.0}, 0.0), Ground(), {}, conditions, seed};
}

TEST(Conditions, PushesAreHeldOffWhileTheRobotWalksCarefully) {
  for (const bool on_stairs : {false, true}) {
    Conditions conditions;
    conditions.pushes = {.min_n = 100.0, .max_n = 100.0, .every_s = 1.0, .on_stairs = on_stairs};
    const Push push = pushes_of(conditions.pushes, 1, 500).at(0);
    Command slow_gait;
    slow_gait.slow_gait = true;
    Robot robot = robot_in(conditions);
    Robot undisturbed = robot_in({});
    for (std::int64_t i = 0; i < push.begin + push.length; ++i) {
      robot.step(slow_gait);
      undisturbed.step(slow_gait);
    }
    EXPECT_EQ(robot.digest() == undisturbed.digest(), !on_stairs);
  }
}

TEST(Conditions, APushMovesARobotThatStands) {
  Conditions conditions;
  conditions.pushes = {.min_n = 100.0, .max_n = 100.0, .every_s = 1.0};
  const Push push = pushes_of(conditions.pushes, 1, 500).at(0);
  Robot robot = robot_in(conditions);
  for (std::int64_t i = 0; i < push.begin; ++i) robot.step({});
  EXPECT_LT(robot.v_W().head<2>().norm(), 0.01);
  for (std::int64_t i = 0; i < push.length; ++i) robot.step({});
  const Eigen::Vector2d v = robot.v_W().head<2>();
  // 100 N for 0.15 s on 33.6 kg is 0.45 m/s, of which the legs take a part; 8 seeds gave 0.249 to 0.255.
  EXPECT_GT(v.dot(push.force_W.normalized()), 0.2);
  EXPECT_LT(v.norm(), 0.45);
}

/// Feet cannot drive a robot faster than friction allows, whatever the gait asks for.
TEST(Conditions, FrictionOfTheFloorBoundsTheAcceleration) {
  const auto speed_after_half_a_second = [](double friction) {
    Conditions conditions;
    conditions.friction = friction;
    Robot robot = robot_in(conditions);
    for (int i = 0; i < 250; ++i) robot.step({1.2, 0.0, 0.0, 1.0});
    return robot.v_W().head<2>().norm();
  };
  const double slippery = speed_after_half_a_second(0.05);
  const double firm = speed_after_half_a_second(0.8);
  EXPECT_LT(slippery, 0.05 * gravity * 0.5);  // measured 0.18
  EXPECT_GT(firm, 0.45);                      // measured 0.51
}

TEST(Conditions, OtherSeedsAreOtherPushes) {
  Conditions conditions;
  conditions.pushes = {.min_n = 50.0, .max_n = 100.0, .every_s = 1.0};
  const auto digest = [&](std::uint64_t seed) {
    Robot robot = robot_in(conditions, seed);
    for (int i = 0; i < 500; ++i) robot.step({0.5, 0.0, 0.0, 1.0});
    return robot.digest();
  };
  const std::uint64_t one = digest(1);
  EXPECT_EQ(digest(1), one);
  EXPECT_NE(digest(2), one);
}

/// A sample of what ci/full does at length: 20 s of turns. Throws when the robot falls; gives the lowest base.
double walk(const Conditions& conditions, std::uint64_t seed) {
  Robot robot = robot_in(conditions, seed);
  double z_min = 1.0;
  for (int i = 0; i < 10000; ++i) {
    robot.step({0.6, 0.0, 0.6 * std::sin(i * step_s * 0.7), 1.0});
    z_min = std::min(z_min, robot.X_WR().t.z());
  }
  return z_min;
}

TEST(Conditions, PushesDoNotFellTheRobot) {
  Conditions conditions;
  conditions.pushes = {.min_n = 60.0, .max_n = 150.0, .every_s = 4.0};
  for (const std::uint64_t seed : {1U, 2U, 3U}) EXPECT_GT(walk(conditions, seed), 0.35) << seed;
}

TEST(Conditions, ASlipperyFloorDoesNotFellTheRobot) {
  Conditions conditions;
  conditions.friction = 0.4;
  EXPECT_GT(walk(conditions, 1), 0.4);
}

TEST(Conditions, AnUnevenFloorShakesTheRobotButDoesNotFellIt) {
  const Conditions even;
  Conditions uneven;
  uneven.terrain_noise_m = 0.015;
  const auto heights = [](const Conditions& conditions) {
    Robot robot = robot_in(conditions);
    double sum = 0.0;
    double squares = 0.0;
    constexpr int count = 5000;
    for (int i = 0; i < 2500; ++i) robot.step({0.6, 0.0, 0.2, 1.0});
    for (int i = 0; i < count; ++i) {
      robot.step({0.6, 0.0, 0.2, 1.0});
      const double z = robot.X_WR().t.z();
      sum += z / count;
      squares += z * z / count;
    }
    return std::sqrt(std::max(0.0, squares - sum * sum));
  };
  EXPECT_GT(heights(uneven), 1.2 * heights(even));  // measured 1.5 times
  EXPECT_GT(walk(uneven, 2), 0.4);
}

}  // namespace
}  // namespace plumbline::sim
